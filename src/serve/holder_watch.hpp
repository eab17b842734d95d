// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "holding.hpp"

#include <cmath>

namespace stylet::serve {

/// Notices that the page that holds the needle has fallen silent, and keeps its hand stopped until the page goes on.
/// Counts turns of a timer instead of time: while the server's own thread hangs, no page can be heard.
class HolderWatch {
 public:
  static constexpr double kTurn_s = 0.1;  ///< period of the timer

  /// @param silence_s [s] the hand is stopped after so long without a message
  explicit HolderWatch(double silence_s) : silent_turns_(static_cast<int>(std::ceil(silence_s / kTurn_s))) {}

  /// Says who holds the needle. The hand of another holder is free.
  void watch(Holding::Viewer holder) {
    if (holder == holder_) return;
    holder_ = holder;
    silent_ = 0;
    is_stopped_ = false;
  }
  /// A viewer has said something.
  void hear(Holding::Viewer viewer) {
    if (viewer == holder_) silent_ = 0;
  }
  /// A turn of the timer has passed. @return whether the hand is to be stopped now
  bool turn() {
    if (holder_ == 0 || is_stopped_ || ++silent_ < silent_turns_) return false;
    is_stopped_ = true;
    return true;
  }
  /// The page that holds the needle knows that its hand was stopped.
  void go_on() { is_stopped_ = false; }
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }

 private:
  int silent_turns_;
  Holding::Viewer holder_ = 0;
  int silent_ = 0;  ///< turns since the last message of the holder
  bool is_stopped_ = false;
};

}  // namespace stylet::serve

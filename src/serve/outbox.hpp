// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "messages.hpp"

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

namespace stylet::serve {

/// The messages that wait for one connection. Of pictures of the needle, of states, and of all messages but scenes,
/// events and notices, only the newest waits.
class Outbox {
 public:
  /// @return false if the page does not read its messages, so that too many wait
  bool put(const Parcel& parcel);
  void put(const std::shared_ptr<const LiveFrame>& frame);
  /// The next message with its number; empty if nothing waits.
  [[nodiscard]] std::optional<wire::Bytes> next();
  /// Number of pictures that were replaced before they were sent.
  [[nodiscard]] std::int64_t skipped_frames() const { return skipped_; }

 private:
  std::deque<Parcel> waiting_;
  std::optional<Parcel> status_;  ///< sent after `waiting_`
  std::shared_ptr<const LiveFrame> frame_;
  std::vector<Step> curve_;   ///< samples that have not been sent
  bool whole_curve_ = false;  ///< curve_ starts at the beginning of the insertion
  std::int64_t skipped_ = 0;
  std::uint32_t sent_ = 0;
};

/// Limits how many messages a page may send: the allowance refills with time.
class Allowance {
 public:
  /// Takes one message. @return false: there were too many
  bool take();

 private:
  static constexpr double kPerSecond = 400.0;
  double left_ = kPerSecond;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace stylet::serve

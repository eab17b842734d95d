// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "housekeeping.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace stylet::serve {

/// Calls make_room() again and again while something is recorded, in a thread of its own: a disk may take its time.
class RoomWatch {
 public:
  using Look = std::function<RoomReport()>;
  /// @param look as make_room() of the recordings' folder
  /// @param say tells people what was removed, and a new warning; from the thread; may be empty
  RoomWatch(Look look, std::function<void(const std::string&)> say, std::chrono::milliseconds every);

  /// Whether something is recorded; from then on looks, at once and then again and again.
  void set_recording(bool is_recording);
  /// The newest report since something is recorded.
  [[nodiscard]] RoomReport report() const;

 private:
  void run(const std::stop_token& stop);
  void tell(const RoomReport& before, const RoomReport& now) const;

  Look look_;
  std::function<void(const std::string&)> say_;
  std::chrono::milliseconds every_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  bool is_recording_ = false;
  int turn_ = 0;  ///< counts recordings
  RoomReport report_;
  std::jthread thread_;  ///< last: starts when the others exist
};

}  // namespace stylet::serve

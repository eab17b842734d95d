// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "housekeeping.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace stylet::serve {

/// Calls make_room() periodically while something is recorded. It has a thread of its own, because a disk may be slow.
class DiskWatch {
 public:
  using Look = std::function<RoomReport()>;
  /// @param look calls make_room() for the recordings' folder
  /// @param say receives messages about removed recordings and new warnings, from the thread; may be empty
  /// @param every period of the calls
  DiskWatch(Look look, std::function<void(const std::string&)> say, std::chrono::milliseconds every);

  /// Starts the periodic calls, the first one at once, or stops them. Clears the report.
  void set_recording(bool is_recording);
  /// The newest report since set_recording(); empty if there is none.
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
  int turn_ = 0;  ///< number of calls of set_recording()
  RoomReport report_;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve

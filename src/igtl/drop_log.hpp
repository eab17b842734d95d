// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/igtl/link.hpp"

#include <chrono>
#include <map>
#include <mutex>

namespace stylet::igtl {

/// Counts the messages and connections that are not used, and says so at a modest rate: of each kind the first at once,
/// and more of them after pauses that double, with their number. May be used from any thread.
class DropLog {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kFirstPause{10};
  static constexpr std::chrono::seconds kLongestPause{640};
  static constexpr std::size_t kMostKinds = 32;  ///< further kinds are counted, and told of as one

  /// @param kind drops of one kind are told of together
  /// @param what a sentence without its full stop
  /// @param is_told_once for messages that are not wanted though nothing is wrong with them
  void add(const std::string& kind, std::string what, std::string cure, bool is_told_once = false);
  /// The sentences about dropped messages that are due now and have not been said.
  std::vector<Dropped> news(Clock::time_point now);
  [[nodiscard]] std::int64_t total() const;

 private:
  struct Entry {
    Dropped newest;
    bool is_told_once = false;
    std::int64_t told = 0;  ///< the count when it was said last
    Clock::time_point due;
    Clock::duration pause = kFirstPause;
  };
  mutable std::mutex mutex_;
  std::map<std::string, Entry> kinds_;  ///< guarded by the mutex
  std::int64_t total_ = 0;              ///< guarded by the mutex
};

}  // namespace stylet::igtl

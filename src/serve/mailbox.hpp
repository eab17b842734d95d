// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "commands.hpp"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stop_token>
#include <utility>

namespace stylet::serve {

/// The requests that wait for the session's thread.
class Mailbox {
 public:
  /// @return false if too many requests are waiting
  bool put(Request request) {
    {
      const std::lock_guard lock(mutex_);
      if (requests_.size() >= kMost) return false;
      requests_.push_back(std::move(request));
    }
    wake_.notify_all();
    return true;
  }
  /// Waits for requests until a moment, or until the thread is to stop, and takes all.
  std::deque<Request> take(const std::stop_token& stop, std::chrono::steady_clock::time_point until) {
    std::unique_lock lock(mutex_);
    wake_.wait_until(lock, stop, until, [&] { return !requests_.empty(); });
    return std::exchange(requests_, {});
  }

 private:
  static constexpr std::size_t kMost = 256;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<Request> requests_;
};

}  // namespace stylet::serve

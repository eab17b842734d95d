// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <span>
#include <type_traits>

namespace stylet {

/// Bounded wait-free queue from one thread to another. If the queue is full, new values are dropped and counted.
template <class T, std::size_t Capacity>
class EventQueue {
  static_assert(std::is_trivially_destructible_v<T>, "what crosses threads owns nothing: copying it never allocates");

 public:
  /// Writer: adds a value. @return false if the queue was full and the value was dropped
  bool push(const T& value) {
    if (queue_.push(value)) return true;
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return false;
  }
  /// Reader: takes the oldest values, at most out.size(). @return number of values taken
  std::size_t pop(std::span<T> out) { return queue_.pop(out.data(), out.size()); }
  /// Number of dropped values; for both sides.
  [[nodiscard]] std::int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  boost::lockfree::spsc_queue<T, boost::lockfree::capacity<Capacity>> queue_;
  std::atomic<std::int64_t> dropped_{0};
};

}  // namespace stylet

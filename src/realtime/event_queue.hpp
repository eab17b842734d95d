// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <span>
#include <type_traits>

namespace stylet {

/// Bounded wait-free queue from one thread to one other that counts what did not fit: what is already in it is kept,
/// what comes to a full queue is dropped.
template <class T, std::size_t Capacity>
class EventQueue {
  static_assert(std::is_trivially_destructible_v<T>, "what crosses threads owns nothing: copying it never allocates");

 public:
  /// Writer. @return false when the queue was full and the value was dropped
  bool push(const T& value) {
    if (queue_.push(value)) return true;
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return false;
  }
  /// Reader: takes the oldest values, as many as there are and fit. @return how many
  std::size_t pop(std::span<T> out) { return queue_.pop(out.data(), out.size()); }
  /// Either side.
  [[nodiscard]] std::int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  boost::lockfree::spsc_queue<T, boost::lockfree::capacity<Capacity>> queue_;
  std::atomic<std::int64_t> dropped_{0};
};

}  // namespace stylet

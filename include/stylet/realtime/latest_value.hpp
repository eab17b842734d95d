// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace stylet {

/// Passes the newest complete value from one writing thread to one reading thread, wait-free on both sides (triple
/// buffer). Each side owns a slot and exchanges it with the third one by a single atomic operation, so neither waits
/// for the other or sees an incomplete value. Values that the reader does not fetch in time are replaced by newer ones.
/// Each further reader needs a LatestValue of its own.
template <class T>
class LatestValue {
  static_assert(std::is_trivially_destructible_v<T>, "what crosses threads owns nothing: copying it never allocates");

 public:
  /// @param initial value for the reader before the first write
  explicit LatestValue(const T& initial = {}) {
    for (Slot& slot : slots_) slot.value = initial;
  }

  /// Writer: the slot to fill in place before publish(). It holds an older value, not necessarily the last one.
  [[nodiscard]] T& draft() { return slots_[back_].value; }
  /// Writer: makes the draft the newest value.
  void publish() {
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }
  /// Writer: copies a value to the draft and publishes it.
  void write(const T& value) {
    draft() = value;
    publish();
  }

  /// Reader: fetches the newest value. @return whether it was published since the last call
  bool fetch() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// Reader: the value last fetched; it stays unchanged until the next fetch().
  [[nodiscard]] const T& value() const { return slots_[front_].value; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;  ///< the middle slot was written after the reader's last fetch
  static constexpr std::size_t kCacheLine = 64;

  struct alignas(kCacheLine) Slot {
    T value;
  };
  std::array<Slot, 3> slots_;
  alignas(kCacheLine) std::atomic<std::uint8_t> middle_{1};
  alignas(kCacheLine) std::uint8_t back_ = 0;   ///< the writer's slot
  alignas(kCacheLine) std::uint8_t front_ = 2;  ///< the reader's slot
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace stylet {

/// The newest complete value of one writing thread for one reading thread, wait-free on both sides (triple buffer):
/// each side owns a slot and trades it for the third one in a single atomic exchange, so neither ever waits for the
/// other nor sees half a value. Values the reader does not fetch in time are replaced by newer ones. More readers need
/// one LatestValue each.
template <class T>
class LatestValue {
  static_assert(std::is_trivially_destructible_v<T>, "what crosses threads owns nothing: copying it never allocates");

 public:
  /// @param initial what the reader sees before the first write
  explicit LatestValue(const T& initial = {}) {
    for (Slot& slot : slots_) slot.value = initial;
  }

  /// Writer: the slot to fill in place; publish() afterwards. Holds an older value, not necessarily the last one.
  [[nodiscard]] T& draft() { return slots_[back_].value; }
  /// Writer: makes the draft the newest value.
  void publish() {
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }
  /// Writer: both in one.
  void write(const T& value) {
    draft() = value;
    publish();
  }

  /// Reader: fetches the newest value. @return true when it was published since the last call
  bool fetch() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// Reader: the value last fetched; stays as it is until the next fetch().
  [[nodiscard]] const T& value() const { return slots_[front_].value; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;  ///< the middle slot was written after the reader last took one
  static constexpr std::size_t kCacheLine = 64;

  struct alignas(kCacheLine) Slot {
    T value;
  };
  std::array<Slot, 3> slots_;
  alignas(kCacheLine) std::atomic<std::uint8_t> middle_{1};
  alignas(kCacheLine) std::uint8_t back_ = 0;   ///< the writer's own
  alignas(kCacheLine) std::uint8_t front_ = 2;  ///< the reader's own
};

}  // namespace stylet

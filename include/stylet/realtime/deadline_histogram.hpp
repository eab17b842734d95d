// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace stylet {

/// Distribution of durations, of fixed size: adding neither allocates nor searches. Up to 64 ns every nanosecond has
/// its own bin, beyond each octave has 64 of equal width, so a bin is never wider than 1/64 (1.6 %) of what it holds;
/// that is the resolution of quantile(). Count, largest value and misses are exact. Plain data; one thread may add()
/// while others take a snapshot().
class DeadlineHistogram {
 public:
  static constexpr int kBinsPerOctave = 64;
  static constexpr int kOctaves = 36;
  /// Longer durations (73 minutes) share the last bin; largest_ns() is exact even so.
  static constexpr std::int64_t kRange_ns = std::int64_t{kBinsPerOctave} << kOctaves;

  DeadlineHistogram() = default;
  /// @param deadline_ns [ns] a duration above it is a miss; 0 = none
  explicit DeadlineHistogram(std::int64_t deadline_ns) : deadline_ns_(deadline_ns) {}

  /// Writer. @param duration_ns [ns] negative ones count as 0
  void add(std::int64_t duration_ns);

  /// Any thread, while another one adds: a copy whose count is the sum of its bins. Take quantiles from that.
  [[nodiscard]] DeadlineHistogram snapshot() const;

  /// Adds what another one has seen; its own deadline was applied there and its misses are taken over.
  void merge(const DeadlineHistogram& other);

  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] std::int64_t largest_ns() const { return largest_ns_; }
  [[nodiscard]] std::int64_t misses() const { return misses_; }
  [[nodiscard]] std::int64_t deadline_ns() const { return deadline_ns_; }

  /// Smallest duration [ns] that a share `q` of all does not exceed, too large by less than 1/64 and never above
  /// largest_ns(); 0 without any. @param q 0…1
  [[nodiscard]] std::int64_t quantile_ns(double q) const;

  /// How many durations do not exceed `duration_ns`; those in the bin that it lies in count as longer unless it is the
  /// bin's end.
  [[nodiscard]] std::int64_t up_to(std::int64_t duration_ns) const;

 private:
  static constexpr int kBins = kBinsPerOctave * (kOctaves + 1);
  [[nodiscard]] static int bin_of(std::int64_t duration_ns);
  [[nodiscard]] static std::int64_t last_of(int bin);

  std::array<std::int64_t, kBins> bins_{};
  std::int64_t count_ = 0;
  std::int64_t largest_ns_ = 0;
  std::int64_t misses_ = 0;
  std::int64_t deadline_ns_ = 0;
};

}  // namespace stylet

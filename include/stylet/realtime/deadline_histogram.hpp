// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace stylet {

/// Histogram of durations, of fixed size; add() neither allocates nor searches. Up to 64 ns every nanosecond has its
/// own bin; beyond that, each octave has 64 bins of equal width, so a bin is never wider than 1/64 (1.6 %) of its
/// durations. This is the resolution of quantile_ns(). Count, largest value and misses are exact. Plain data; one
/// thread may call add() while others call snapshot().
class DeadlineHistogram {
 public:
  static constexpr int kBinsPerOctave = 64;
  static constexpr int kOctaves = 36;
  /// Durations longer than this (73 minutes) share the last bin; largest_ns() is exact for them as well.
  static constexpr std::int64_t kRange_ns = std::int64_t{kBinsPerOctave} << kOctaves;

  DeadlineHistogram() = default;
  /// @param deadline_ns [ns] longer durations count as misses; 0 = no deadline
  explicit DeadlineHistogram(std::int64_t deadline_ns) : deadline_ns_(deadline_ns) {}

  /// Adds a duration. For the writing thread only. @param duration_ns [ns] negative values count as 0
  void add(std::int64_t duration_ns);

  /// A copy whose count is the sum of its bins. For any thread, also while another thread adds durations; compute
  /// quantiles from the copy.
  [[nodiscard]] DeadlineHistogram snapshot() const;

  /// Adds all durations of another histogram. The misses of `other` were counted with its own deadline and are
  /// added unchanged.
  void merge(const DeadlineHistogram& other);

  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] std::int64_t largest_ns() const { return largest_ns_; }
  [[nodiscard]] std::int64_t misses() const { return misses_; }
  [[nodiscard]] std::int64_t deadline_ns() const { return deadline_ns_; }

  /// The q-quantile of the durations [ns], too large by less than 1/64 and never above largest_ns(); 0 if there are no
  /// durations. @param q 0…1
  [[nodiscard]] std::int64_t quantile_ns(double q) const;

  /// Number of durations of at most `duration_ns`. Durations in the same bin as `duration_ns` count as longer, unless
  /// `duration_ns` is the end of the bin.
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

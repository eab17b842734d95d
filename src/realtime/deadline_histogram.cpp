// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/deadline_histogram.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace stylet {

namespace {

constexpr int kBinBits = std::countr_zero(static_cast<unsigned>(DeadlineHistogram::kBinsPerOctave));

/// Stores a number. Since only one thread writes, a relaxed store without a locked operation is sufficient.
void put(std::int64_t& number, std::int64_t value) {
  std::atomic_ref<std::int64_t>(number).store(value, std::memory_order_relaxed);
}

std::int64_t get(const std::int64_t& number) {
  // C++20 has no atomic_ref of a const object; load() does not write.
  return std::atomic_ref<std::int64_t>(const_cast<std::int64_t&>(number)).load(std::memory_order_relaxed);
}

}  // namespace

int DeadlineHistogram::bin_of(std::int64_t duration_ns) {
  if (duration_ns < kBinsPerOctave) return static_cast<int>(std::max<std::int64_t>(duration_ns, 0));
  if (duration_ns >= kRange_ns) return kBins - 1;
  const int octave = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(duration_ns))) - 1 - kBinBits;
  const auto within = static_cast<int>(duration_ns >> octave) - kBinsPerOctave;
  return kBinsPerOctave * (octave + 1) + within;
}

std::int64_t DeadlineHistogram::last_of(int bin) {
  if (bin < kBinsPerOctave) return bin;
  const int octave = bin / kBinsPerOctave - 1;
  const std::int64_t first = std::int64_t{kBinsPerOctave + bin % kBinsPerOctave} << octave;
  return first + (std::int64_t{1} << octave) - 1;
}

void DeadlineHistogram::add(std::int64_t duration_ns) {
  std::int64_t& bin = bins_[static_cast<std::size_t>(bin_of(duration_ns))];
  put(bin, bin + 1);
  put(count_, count_ + 1);
  if (duration_ns > largest_ns_) put(largest_ns_, duration_ns);
  if (deadline_ns_ > 0 && duration_ns > deadline_ns_) put(misses_, misses_ + 1);
}

DeadlineHistogram DeadlineHistogram::snapshot() const {
  DeadlineHistogram copy(deadline_ns_);
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    copy.bins_[k] = get(bins_[k]);
    copy.count_ += copy.bins_[k];
  }
  copy.largest_ns_ = get(largest_ns_);
  copy.misses_ = get(misses_);
  return copy;
}

void DeadlineHistogram::merge(const DeadlineHistogram& other) {
  for (std::size_t k = 0; k < bins_.size(); ++k) bins_[k] += other.bins_[k];
  count_ += other.count_;
  largest_ns_ = std::max(largest_ns_, other.largest_ns_);
  misses_ += other.misses_;
}

std::int64_t DeadlineHistogram::up_to(std::int64_t duration_ns) const {
  std::int64_t seen = 0;
  for (int bin = 0; bin < kBins - 1 && last_of(bin) <= duration_ns; ++bin) seen += bins_[static_cast<std::size_t>(bin)];
  return duration_ns >= largest_ns_ ? count_ : seen;
}

std::int64_t DeadlineHistogram::quantile_ns(double q) const {
  if (count_ == 0) return 0;
  const auto wanted = static_cast<std::int64_t>(std::ceil(std::clamp(q, 0.0, 1.0) * static_cast<double>(count_)));
  std::int64_t seen = 0;
  for (int bin = 0; bin < kBins - 1; ++bin) {
    seen += bins_[static_cast<std::size_t>(bin)];
    if (seen >= std::max<std::int64_t>(wanted, 1)) return std::min(last_of(bin), largest_ns_);
  }
  return largest_ns_;
}

}  // namespace stylet

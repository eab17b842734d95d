// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/dose_volume.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace stylet {

namespace {
constexpr double kMm3PerCc = 1000.0;
}

DoseVolume::DoseVolume(std::span<const double> dose_Gy, std::span<const double> volume_mm3) {
  std::vector<std::size_t> order(dose_Gy.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return dose_Gy[a] > dose_Gy[b]; });
  dose_.reserve(order.size());
  volume_.reserve(order.size());
  double sum = 0.0;
  for (const std::size_t k : order) {
    sum += volume_mm3[k];
    dose_.push_back(dose_Gy[k]);
    volume_.push_back(sum);
  }
}

double DoseVolume::volume_cc() const { return volume_.empty() ? 0.0 : volume_.back() / kMm3PerCc; }

double DoseVolume::dose_of_volume(double cc) const {
  // A sum of many volumes may miss a round share by its rounding.
  const double wanted = cc * kMm3PerCc * (1.0 - 1e-12);
  if (dose_.empty() || wanted > volume_.back()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = std::lower_bound(volume_.begin(), volume_.end(), wanted);
  const auto k = std::min(static_cast<std::size_t>(at - volume_.begin()), dose_.size() - 1);
  return dose_[k];
}

double DoseVolume::dose_of_percent(double percent) const { return dose_of_volume(0.01 * percent * volume_cc()); }

double DoseVolume::volume_above_cc(double dose_Gy) const {
  const auto below = std::partition_point(dose_.begin(), dose_.end(), [&](double d) { return d >= dose_Gy; });
  return below == dose_.begin() ? 0.0 : volume_[static_cast<std::size_t>(below - dose_.begin()) - 1] / kMm3PerCc;
}

double DoseVolume::percent_above(double dose_Gy) const {
  return dose_.empty() ? std::numeric_limits<double>::quiet_NaN() : 100.0 * volume_above_cc(dose_Gy) / volume_cc();
}

double DoseVolume::mean_Gy() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < dose_.size(); ++k) sum += dose_[k] * (volume_[k] - (k == 0 ? 0.0 : volume_[k - 1]));
  return dose_.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / volume_.back();
}

}  // namespace stylet

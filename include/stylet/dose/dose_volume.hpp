// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

namespace stylet {

/// The dose–volume histogram of a structure, from samples and without bins: every figure is exact for the samples.
class DoseVolume {
 public:
  /// @param dose_Gy dose of each sample @param volume_mm3 (dose_Gy.size()) volume that each sample stands for, > 0
  DoseVolume(std::span<const double> dose_Gy, std::span<const double> volume_mm3);

  [[nodiscard]] double volume_cc() const;
  /// D90 for 90: the largest dose [Gy] that at least this share of the volume receives. @param percent 0 … 100
  [[nodiscard]] double dose_of_percent(double percent) const;
  /// D2cc for 2: the largest dose [Gy] that at least this volume receives. NaN where the structure is smaller: such a
  /// figure does not exist (figures_left_out() says so in words). @param cc > 0
  [[nodiscard]] double dose_of_volume(double cc) const;
  /// V100 for the prescribed dose: share [%] of the volume that receives at least this dose.
  [[nodiscard]] double percent_above(double dose_Gy) const;
  /// The same as a volume [cc].
  [[nodiscard]] double volume_above_cc(double dose_Gy) const;
  [[nodiscard]] double mean_Gy() const;

 private:
  std::vector<double> dose_;    // descending
  std::vector<double> volume_;  // of all samples up to this one, the hottest first [mm³]
};

}  // namespace stylet

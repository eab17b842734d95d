// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/evaluate.hpp"

#include <vector>

namespace stylet {

/// The dose that a structure has received by a moment after the implantation.
struct DoseMoment {
  double days = 0.0;                     ///< [d] after the implantation; infinity: until the sources have decayed
  double share = 0.0;                    ///< 0 … 1, of their dose that the sources have given by then
  double d90_Gy = 0.0;                   ///< D90 of the dose that the structure has received
  double d90_without_swelling_Gy = 0.0;  ///< the same in tissue that does not swell

  [[nodiscard]] double taken_away_Gy() const { return d90_without_swelling_Gy - d90_Gy; }
};

/// How the dose to a structure grows over the time of a permanent implant, in tissue that swells and in tissue that
/// does not.
struct DoseCourse {
  std::vector<DoseMoment> moments;  ///< the first at the implantation, the last when the sources have decayed
  Swelling swelling;
  double half_life_days = 0.0;  ///< [d] of the sources
  std::size_t samples = 0;      ///< number of samples that stand for the structure

  /// The course at any time: between two moments D90 grows in proportion to the dose that the sources give.
  /// @param days [d] ≥ 0
  [[nodiscard]] DoseMoment at(double days) const;
  /// Days until half of what the swelling takes away from D90 in the end has been taken away; NaN where it takes
  /// nothing.
  [[nodiscard]] double days_until_half_is_taken() const;
};

/// Computes the D90 of a structure over the time of a permanent implant. The moments are those between the parts of
/// swollen_times(), so that the last one is the D90 that evaluate_dose() finds, within its table and the thinning. A
/// structure of more than 100,000 samples is thinned to that number, since only D90 is asked for.
/// @param samples of the structure, without swelling
/// @param options its formalism, decay and swelling; quantity and the rest are not used
/// Errors: a temporary implant, which ends before tissue swells; no source in the plan; no samples; those of
/// Tg43::create().
Result<DoseCourse> d90_over_time(const DosePlan& plan, const SourceModel& source, const StructureSamples& samples,
                                 const DoseOptions& options);

}  // namespace stylet

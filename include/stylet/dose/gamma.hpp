// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace stylet {

/// Criteria of the gamma index.
struct GammaCriteria {
  double dose_percent = 3.0;        ///< dose difference [%] that is allowed
  double distance_mm = 1.0;         ///< distance to agreement [mm]
  double threshold_percent = 10.0;  ///< points with less than this share [%] of the global dose are not judged
};

/// Share of the points whose gamma index is at most 1.
struct GammaRates {
  GammaCriteria criteria;
  double global_Gy = 0.0;       ///< dose that the global criterion and the threshold are a share of
  std::size_t points = 0;       ///< number of points judged
  double local_percent = 0.0;   ///< pass rate [%], dose difference in percent of the dose at the point
  double global_percent = 0.0;  ///< pass rate [%], dose difference in percent of global_Gy
};

/// Doses [Gy] at points [mm].
using DoseAtPoints = std::function<Result<std::vector<double>>(std::span<const Vec3>)>;

/// Gamma index of Low et al. (Med Phys 25:656, 1998) with the points as the reference: a point passes if somewhere
/// within the distance to agreement the evaluated dose fulfils (r/Δd)² + (ΔD/ΔD_allowed)² ≤ 1. The evaluated dose is
/// asked for at steps of a fifth of the distance along 100 rays that are spread evenly over all directions, and taken
/// as linear between the steps (as Ju et al., Med Phys 35:879, 2008, do between grid points). Of more than 10,000
/// points every second, third, … is judged.
/// @param points [mm] @param reference_Gy (points.size()) doses of the reference
/// @param evaluated_Gy (points.size()) evaluated dose at the same points @param evaluated the same dose anywhere
/// @param global_Gy > 0 @returns the error of `evaluated`, if it has one
Result<GammaRates> gamma_rates(std::span<const Vec3> points, std::span<const double> reference_Gy,
                               std::span<const double> evaluated_Gy, const DoseAtPoints& evaluated, double global_Gy,
                               const GammaCriteria& criteria = {});

}  // namespace stylet

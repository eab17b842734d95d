// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <vector>

namespace stylet::results {

/// Cumulative dose–volume histograms of all structures at the same doses.
struct DvhTable {
  std::vector<double> dose_Gy;               ///< (k) from 0 in equal steps
  std::vector<std::vector<double>> percent;  ///< (structures × k) share [%] of the volume with at least this dose
};

/// The histograms at doses in steps of 1 % of the prescribed dose, at most 400 steps. Without a prescription the step
/// is a round number, so that the hottest 1 % of every structure begins within 400 steps. The table ends at the first
/// dose that no structure receives.
DvhTable dvh_table(const DoseEvaluation& evaluation);

/// The histograms at given doses.
DvhTable dvh_at(const DoseEvaluation& evaluation, const std::vector<double>& dose_Gy);

}  // namespace stylet::results

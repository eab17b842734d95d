// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/seed_errors.hpp"

#include <string>
#include <vector>

namespace stylet::results {

/// A curve of the picture of distances.
struct DistanceCurve {
  std::string name;
  const std::vector<SeedHistory>* seeds = nullptr;  ///< not null
  std::string colour;
  std::string dashes;  ///< as in SVG; empty: a solid line
};

/// The share of the seeds that rest within a distance from their planned place, over this distance, as SVG; empty
/// where no curve has a seed that is left in the patient.
std::string distance_picture(const std::vector<DistanceCurve>& curves);

}  // namespace stylet::results

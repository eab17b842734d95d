// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace stylet::results {

/// The cube that the sections show: sources and target with some room.
struct DoseView {
  Vec3 centre_mm = Vec3::Zero();  ///< centre of the target's box; without a target, of the sources' box
  double half_mm = 0.0;           ///< half of the cube's edge
};
DoseView dose_view(const DoseEvaluation& evaluation);

/// A dose at which the sections have a line.
struct IsodoseLevel {
  double dose_Gy = 0.0;
  std::string label;   ///< such as "100 %", or "80 Gy" without a prescription
  std::string colour;  ///< "#rrggbb", from cold to hot: blue, green, orange, red
  bool main = false;   ///< the prescribed dose
};

/// 50, 100, 150 and 200 % of the prescribed dose; without one, round doses about the median dose of the target.
std::vector<IsodoseLevel> isodose_levels(const DoseEvaluation& evaluation);

/// The dose within the view, on a grid along the patient's axes, in steps of scale_Gy.
struct ViewedDose {
  std::array<int, 3> size{0, 0, 0};
  Vec3 origin_mm = Vec3::Zero();
  double spacing_mm = 1.0;
  double scale_Gy = 1.0;
  double ceiling_Gy = 0.0;           ///< doses above are given as this one
  std::vector<std::uint16_t> value;  ///< x varies fastest
};

/// @param most_points size of the result, about; the spacing is that of the grid or larger
ViewedDose viewed_dose(const DoseGrid& grid, const DoseView& view, double ceiling_Gy, double most_points);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/dose_view.hpp"

#include <cstdint>
#include <vector>

namespace stylet::results {

/// A difference of doses within the view, on a grid along the patient's axes.
struct ViewedDifference {
  std::array<int, 3> size{0, 0, 0};
  Vec3 origin_mm = Vec3::Zero();
  double spacing_mm = 1.0;
  double limit_Gy = 1.0;            ///< differences beyond ± this one are given as this one
  std::vector<std::uint8_t> value;  ///< 0: not known; 1 … 255: −limit_Gy … limit_Gy; x varies fastest
};

/// @param difference NaN where it is not known @param most_points size of the result, about
ViewedDifference viewed_difference(const DoseGrid& difference, const DoseView& view, double limit_Gy,
                                   double most_points);

}  // namespace stylet::results

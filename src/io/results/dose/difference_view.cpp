// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/difference_view.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::results {
namespace {

Eigen::AlignedBox3d known_box(const DoseGrid& difference) {
  Eigen::AlignedBox3d box;
  std::size_t n = 0;
  for (Index k = 0; k < difference.size[2]; ++k) {
    for (Index j = 0; j < difference.size[1]; ++j) {
      for (Index i = 0; i < difference.size[0]; ++i, ++n) {
        if (std::isfinite(difference.dose_Gy[n])) box.extend(difference.point(i, j, k));
      }
    }
  }
  return box;
}

}  // namespace

ViewedDifference viewed_difference(const DoseGrid& difference, const DoseView& view, double limit_Gy,
                                   double most_points) {
  ViewedDifference seen;
  seen.limit_Gy = limit_Gy;
  const Vec3 half = Vec3::Constant(view.half_mm);
  Eigen::AlignedBox3d box(Vec3(view.centre_mm - half), Vec3(view.centre_mm + half));
  box = box.intersection(known_box(difference));
  if (box.isEmpty() || !(limit_Gy > 0.0)) return seen;
  seen.spacing_mm = std::max({1.0, difference.spacing_mm.minCoeff(), std::cbrt(box.volume() / most_points)});
  seen.origin_mm = box.min();
  for (int k = 0; k < 3; ++k)
    seen.size[static_cast<std::size_t>(k)] = static_cast<int>(std::floor(box.sizes()[k] / seen.spacing_mm + 1e-6)) + 1;
  for (int k = 0; k < seen.size[2]; ++k) {
    for (int j = 0; j < seen.size[1]; ++j) {
      for (int i = 0; i < seen.size[0]; ++i) {
        const Vec3 x = seen.origin_mm + seen.spacing_mm * Vec3(i, j, k);
        const double at = difference.covers(x) ? difference.at(x) : NAN;  // NaN beside a point that is not known
        const double share = std::clamp(at / limit_Gy, -1.0, 1.0);
        seen.value.push_back(std::isfinite(at) ? static_cast<std::uint8_t>(std::lround(128.0 + 127.0 * share)) : 0);
      }
    }
  }
  return seen;
}

}  // namespace stylet::results

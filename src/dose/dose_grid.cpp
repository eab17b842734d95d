// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/dose_grid.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// Allowance for rounding of places at the grid's rim, in steps of the grid.
constexpr double kRim = 1e-6;

/// Place of x in steps of the grid.
Vec3 in_steps(const DoseGrid& grid, const Vec3& x) {
  return (grid.direction.transpose() * (x - grid.origin_mm)).cwiseQuotient(grid.spacing_mm);
}

}  // namespace

std::size_t DoseGrid::count() const {
  return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
}

Vec3 DoseGrid::point(Index i, Index j, Index k) const {
  return origin_mm + direction * spacing_mm.cwiseProduct(Vec3(i, j, k));
}

bool DoseGrid::covers(const Vec3& x) const {
  const Vec3 steps = in_steps(*this, x);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = steps[static_cast<Eigen::Index>(axis)];
    if (!(step >= -kRim && step <= size[axis] - 1 + kRim)) return false;
  }
  return true;
}

double DoseGrid::at(const Vec3& x) const {
  const Vec3 steps = in_steps(*this, x);
  std::array<std::size_t, 3> low{}, high{};
  std::array<double, 3> share{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = std::clamp(steps[static_cast<Eigen::Index>(axis)], 0.0, static_cast<double>(size[axis] - 1));
    low[axis] = static_cast<std::size_t>(std::min(std::floor(step), std::max(0.0, size[axis] - 2.0)));
    high[axis] = std::min(low[axis] + 1, static_cast<std::size_t>(size[axis] - 1));
    share[axis] = step - static_cast<double>(low[axis]);
  }
  const auto row = static_cast<std::size_t>(size[0]);
  const auto layer = row * static_cast<std::size_t>(size[1]);
  double sum = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<std::size_t, 3> at{};
    double weight = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool upper = (corner >> axis & 1U) != 0U;
      at[axis] = upper ? high[axis] : low[axis];
      weight *= upper ? share[axis] : 1.0 - share[axis];
    }
    if (weight > 0.0) sum += weight * static_cast<double>(dose_Gy[at[0] + row * at[1] + layer * at[2]]);
  }
  return sum;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sizing.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

constexpr double kDoubling = 14.0;      // [mm] distance from the target's surface over which the size doubles
constexpr double kLargestGrowth = 7.0;  // largest size / size in the target
constexpr double kLimitGrowth = 0.35;   // [mm/mm] growth of a structure's size limit with the distance from it
constexpr double kSoftness = 0.5;       // exponent of wanted size / limit beyond the limit

/// Element size that resolves a structure of a given half thickness R [mm]: 1.15 R at R = 2.5 mm, 0.7 R at 25 mm.
double resolving_size(double half_thickness) { return 1.4 * std::pow(half_thickness, 0.79); }

/// Soft minimum of size and limit. With a hard one, thin structures could take all nodes of a coarse mesh and the scale
/// would have no effect.
double bounded(double wanted, double limit) {
  return wanted < limit ? wanted : limit * std::pow(wanted / limit, kSoftness);
}

}  // namespace

SizeField::SizeField(const Anatomy& a, MeshPreset preset) {
  const Eigen::AlignedBox3d box = a.box();
  const double step = std::max(2.0, std::cbrt(box.volume() / 400000));
  GridShape grid;
  grid.low = box.min();
  for (int c = 0; c < 3; ++c) grid.size[c] = std::max(2, static_cast<int>(std::ceil(box.sizes()[c] / step)) + 1);
  for (int c = 0; c < 3; ++c) grid.spacing[c] = box.sizes()[c] / (grid.size[c] - 1);
  grid.values.resize(static_cast<std::size_t>(grid.size[0]) * grid.size[1] * grid.size[2]);
  growth_ = limit_ = grid;
  inside_.resize(grid.values.size());
  std::vector<double> thin;
  for (const Structure& s : a.structures) thin.push_back(resolving_size(s.shape->inner_radius()));
  const double doubling = preset == MeshPreset::paper ? 2 * kDoubling : kDoubling;
  std::size_t n = 0;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i, ++n) {
        const Vec3 p = grid.node(i, j, k);
        const double away = std::max(0.0, a.target_distance(p));
        growth_.values[n] = static_cast<float>(std::min(kLargestGrowth, 1 + away / doubling));
        double limit = HUGE_VAL;
        for (std::size_t s = 0; s < thin.size(); ++s) {
          const double d = std::max(0.0, a.structures[s].shape->distance(p));
          limit = std::min(limit, thin[s] + kLimitGrowth * d);
        }
        limit_.values[n] = static_cast<float>(limit);
        inside_[n] = a.label(p) != 0;
      }
    }
  }
}

double SizeField::operator()(const Vec3& p, double scale) const {
  return bounded(scale * growth_.distance(p), limit_.distance(p));
}

double SizeField::scale_for(double nodes) const {
  // A body of volume V with elements of edge length h has about 1.1 √2 V / h³ nodes.
  double low = 0.05, high = 100;
  for (int i = 0; i < 30; ++i) {
    const double scale = std::sqrt(low * high);
    double count = 0;
    for (std::size_t n = 0; n < inside_.size(); ++n) {
      if (!inside_[n]) continue;
      const double h = bounded(scale * growth_.values[n], limit_.values[n]);
      count += 1 / (h * h * h);
    }
    count *= 1.5 * growth_.spacing.prod();
    (count > nodes ? low : high) = scale;
  }
  return std::sqrt(low * high);
}

}  // namespace stylet::meshing

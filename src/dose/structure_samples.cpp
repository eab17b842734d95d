// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/structure_samples.hpp"

#include "dose/sampling.hpp"
#include "stylet/geom/structure_slices.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace stylet {

namespace {

/// Places along a row at height v where a contour is crossed, ascending.
void crossings(const StructureSlice& slice, double v, std::vector<double>& at) {
  at.clear();
  for (const Polygon& polygon : slice.polygons) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Eigen::Vector2d& a = polygon[k];
      const Eigen::Vector2d& b = polygon[(k + 1) % polygon.size()];
      if ((a.y() > v) == (b.y() > v)) continue;
      at.push_back(a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
  }
  std::sort(at.begin(), at.end());
}

}  // namespace

double StructureSamples::volume_cc() const {
  return std::accumulate(volume_mm3.begin(), volume_mm3.end(), 0.0) / 1000.0;
}

Result<StructureSamples> sample_structure(const Roi& roi, double step_mm) {
  const std::string where = "structure '" + roi.name + "'";
  if (Result<> good = dose::check_step(step_mm, where); !good) return good.error();
  const Result<StructureSlices> meant = structure_slices(roi, "");
  if (!meant) return meant.error();
  StructureSamples samples;
  std::vector<double> at;
  for (const StructureSlice& slice : meant->slices) {
    Eigen::AlignedBox2d box;
    for (const Polygon& polygon : slice.polygons) {
      for (const Eigen::Vector2d& x : polygon) box.extend(x);
    }
    const double thickness = slice.thickness();
    const int layers = std::max(1, static_cast<int>(std::ceil(thickness / step_mm - 1e-9)));
    const double area_bound = box.sizes().prod() / (step_mm * step_mm);
    if (static_cast<double>(samples.points.size()) + area_bound * layers > dose::kMostSamples)
      return dose::too_many_samples(step_mm, where);
    const double volume = step_mm * step_mm * thickness / layers;
    // Samples lie in the middle of squares whose corners are multiples of the step.
    const auto middle = [&](double number) { return (number + 0.5) * step_mm; };
    for (double row = std::floor(box.min().y() / step_mm); middle(row) < box.max().y(); ++row) {
      crossings(slice, middle(row), at);
      for (std::size_t pair = 0; pair + 1 < at.size(); pair += 2) {
        for (double column = std::ceil(at[pair] / step_mm - 0.5); middle(column) < at[pair + 1]; ++column) {
          for (int layer = 0; layer < layers; ++layer) {
            const double h = slice.height - slice.below + (layer + 0.5) * thickness / layers;
            samples.points.push_back(meant->frame.lps(Vec3(middle(column), middle(row), h)));
            samples.volume_mm3.push_back(volume);
          }
        }
      }
    }
  }
  return samples;
}

}  // namespace stylet

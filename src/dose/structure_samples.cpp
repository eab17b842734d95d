// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/structure_samples.hpp"

#include "dose/sampling.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace stylet {

namespace {

/// [mm] Contours whose heights differ by less are in one plane: files round their coordinates.
constexpr double kSamePlane_mm = 0.02;
/// A gap between planes of more than so many times the usual distance is not bridged.
constexpr double kWideGap = 2.5;

using Polygon = std::vector<Eigen::Vector2d>;

/// The contours of one plane, and the slab that they stand for.
struct Slab {
  double height = 0.0;  // [mm] of the plane along the normal
  double from = 0.0;
  double to = 0.0;
  std::vector<Polygon> polygons;
};

/// Axes of the planes: two in the plane, and the normal.
struct PlaneAxes {
  Vec3 origin = Vec3::Zero(), across = Vec3::UnitX(), up = Vec3::UnitY(), normal = Vec3::UnitZ();
  [[nodiscard]] Vec3 point(double u, double v, double h) const { return origin + u * across + v * up + h * normal; }
};

/// Twice the area of a contour times its normal.
Vec3 area_vector(const Contour& contour) {
  Vec3 sum = Vec3::Zero();
  const Vec3& first = contour.points.front();
  for (std::size_t k = 1; k + 1 < contour.points.size(); ++k)
    sum += (contour.points[k] - first).cross(contour.points[k + 1] - first);
  return sum;
}

/// Axes that belong to the structure: from the centre of its largest contour towards the first point of that contour. A
/// structure that is turned and moved has the same samples, turned and moved.
PlaneAxes axes_of(const Roi& roi) {
  const Contour* largest = nullptr;
  Vec3 area = Vec3::Zero();
  for (const Contour& contour : roi.contours) {
    if (contour.points.size() < 3) continue;
    const Vec3 its_area = area_vector(contour);
    if (largest != nullptr && its_area.norm() <= area.norm()) continue;
    largest = &contour;
    area = its_area;
  }
  PlaneAxes axes;
  if (largest == nullptr) return axes;
  if (!area.isZero()) axes.normal = area.normalized();
  for (const Vec3& x : largest->points) axes.origin += x / static_cast<double>(largest->points.size());
  Vec3 start = largest->points.front() - axes.origin;
  start -= start.dot(axes.normal) * axes.normal;
  axes.across = start.isZero() ? axes.normal.unitOrthogonal() : Vec3(start.normalized());
  axes.up = axes.normal.cross(axes.across);
  return axes;
}

std::vector<Slab> slabs_of(const Roi& roi, const PlaneAxes& axes) {
  std::vector<Slab> slabs;
  for (const Contour& contour : roi.contours) {
    if (contour.points.size() < 3) continue;
    Polygon polygon;
    double height = 0.0;
    for (const Vec3& x : contour.points) {
      const Vec3 from = x - axes.origin;
      polygon.emplace_back(from.dot(axes.across), from.dot(axes.up));
      height += from.dot(axes.normal) / static_cast<double>(contour.points.size());
    }
    auto slab = std::find_if(slabs.begin(), slabs.end(),
                             [&](const Slab& s) { return std::abs(s.height - height) < kSamePlane_mm; });
    if (slab == slabs.end()) {
      slabs.push_back({.height = height});
      slab = slabs.end() - 1;
    }
    slab->polygons.push_back(std::move(polygon));
  }
  std::sort(slabs.begin(), slabs.end(), [](const Slab& a, const Slab& b) { return a.height < b.height; });
  return slabs;
}

/// Puts the ends of all slabs half-way to their neighbours.
void set_ends(std::vector<Slab>& slabs) {
  std::vector<double> gaps;
  for (std::size_t k = 1; k < slabs.size(); ++k) gaps.push_back(slabs[k].height - slabs[k - 1].height);
  std::vector<double> sorted = gaps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    const auto half = [&](std::size_t gap) { return gaps[gap] > kWideGap * usual ? 0.5 * usual : 0.5 * gaps[gap]; };
    const double below = half(k == 0 ? 0 : k - 1);
    const double above = half(k + 1 == slabs.size() ? k - 1 : k);
    slabs[k].from = slabs[k].height - below;
    slabs[k].to = slabs[k].height + above;
  }
}

/// Places along a row at height v where a contour is crossed, ascending.
void crossings(const Slab& slab, double v, std::vector<double>& at) {
  at.clear();
  for (const Polygon& polygon : slab.polygons) {
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
  const PlaneAxes axes = axes_of(roi);
  std::vector<Slab> slabs = slabs_of(roi, axes);
  if (slabs.size() < 2) {
    return input_error(where, "its contours lie in " + std::to_string(slabs.size()) + " plane, at least 2 are needed",
                       "Contour it on more planes");
  }
  set_ends(slabs);
  StructureSamples samples;
  std::vector<double> at;
  for (const Slab& slab : slabs) {
    Eigen::AlignedBox2d box;
    for (const Polygon& polygon : slab.polygons) {
      for (const Eigen::Vector2d& x : polygon) box.extend(x);
    }
    const double thickness = slab.to - slab.from;
    const int layers = std::max(1, static_cast<int>(std::ceil(thickness / step_mm - 1e-9)));
    const double area_bound = box.sizes().prod() / (step_mm * step_mm);
    if (static_cast<double>(samples.points.size()) + area_bound * layers > dose::kMostSamples)
      return dose::too_many_samples(step_mm, where);
    const double volume = step_mm * step_mm * thickness / layers;
    // Samples lie in the middle of squares whose corners are multiples of the step.
    const auto middle = [&](double number) { return (number + 0.5) * step_mm; };
    for (double row = std::floor(box.min().y() / step_mm); middle(row) < box.max().y(); ++row) {
      crossings(slab, middle(row), at);
      for (std::size_t pair = 0; pair + 1 < at.size(); pair += 2) {
        for (double column = std::ceil(at[pair] / step_mm - 0.5); middle(column) < at[pair + 1]; ++column) {
          for (int layer = 0; layer < layers; ++layer) {
            const double h = slab.from + (layer + 0.5) * thickness / layers;
            samples.points.push_back(axes.point(middle(column), middle(row), h));
            samples.volume_mm3.push_back(volume);
          }
        }
      }
    }
  }
  return samples;
}

}  // namespace stylet

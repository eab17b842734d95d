// SPDX-License-Identifier: GPL-3.0-or-later
#include "xray_rods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

/// A part of a ray, by depth: lengths along the central ray.
struct DepthInterval {
  double from = 0.0, to = 0.0;
  [[nodiscard]] double length() const { return std::max(0.0, to - from); }
};

DepthInterval joined_intervals(const DepthInterval& a, const DepthInterval& b) {
  if (a.length() <= 0.0) return b;
  if (b.length() <= 0.0) return a;
  return {std::min(a.from, b.from), std::max(a.to, b.to)};
}

/// The part of a ray x(s) = start + s · direction where |x| ≤ radius: a s² + 2 b s + c ≤ 0.
DepthInterval where_not_positive(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant <= 0.0 || a <= 0.0) return {};
  const double half = std::sqrt(discriminant);
  return {(-b - half) / a, (-b + half) / a};
}

/// The dot product of the rays of a picture with a vector, which is linear in column and row.
class RayDot {
 public:
  RayDot(const XrayGeometry& unit, const Vec3& vector)
      : per_column_(unit.pixel_mm / unit.source_distance_mm * unit.right.dot(vector)),
        per_row_(-unit.pixel_mm / unit.source_distance_mm * unit.up.dot(vector)),
        first_(unit.towards.dot(vector) - unit.middle() * (per_column_ + per_row_)) {}
  [[nodiscard]] double at(double column, double row) const { return first_ + column * per_column_ + row * per_row_; }

 private:
  double per_column_, per_row_, first_;
};

/// A plane that divides a tube. Each point of a ray is on one of its sides, also where rounding decides.
class DividingPlane {
 public:
  DividingPlane(const XrayGeometry& unit, const Vec3& on_plane, const Vec3& normal)
      : speed_(unit, normal), start_((unit.source_mm() - on_plane).dot(normal)) {}

  /// The part of an interval of a ray on the side that the normal points to, or on the other side.
  [[nodiscard]] DepthInterval part(DepthInterval interval, bool ahead, double column, double row) const {
    const double speed = speed_.at(column, row);
    if (speed == 0.0) return (start_ > 0.0) == ahead ? interval : DepthInterval{};
    const double crossing = -start_ / speed;
    if ((speed > 0.0) == ahead) {
      interval.from = std::max(interval.from, crossing);
    } else {
      interval.to = std::min(interval.to, crossing);
    }
    return interval;
  }

 private:
  RayDot speed_;
  double start_;
};

/// A ray as seen from an axis through a point: the numbers from which its lengths in cylinders and balls follow.
struct RayAtAxis {
  double square;      ///< of the ray's direction
  double along_axis;  ///< direction · axis
  double to_point;    ///< direction · (source − point)
};

/// Bodies around an axis through a point.
class AroundAxis {
 public:
  AroundAxis(const XrayGeometry& unit, const Vec3& point, const Vec3& axis)
      : to_source_(unit.source_mm() - point),
        source_along_(to_source_.dot(axis)),
        scale_(unit.pixel_mm / unit.source_distance_mm),
        middle_(unit.middle()),
        along_axis_(unit, axis),
        to_point_(unit, to_source_) {}

  [[nodiscard]] RayAtAxis ray(double column, double row) const {
    const double across = scale_ * (column - middle_);
    const double down = scale_ * (row - middle_);
    return {1.0 + across * across + down * down, along_axis_.at(column, row), to_point_.at(column, row)};
  }
  /// In an endless cylinder.
  [[nodiscard]] DepthInterval in_cylinder(const RayAtAxis& ray, double radius) const {
    constexpr double kParallel = 1e-12;  // square of an angle
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    const double across = ray.square - ray.along_axis * ray.along_axis;
    const double outside = to_source_.squaredNorm() - source_along_ * source_along_ - radius * radius;
    if (across < kParallel) return outside <= 0.0 ? DepthInterval{-kEndless, kEndless} : DepthInterval{};
    return where_not_positive(across, ray.to_point - ray.along_axis * source_along_, outside);
  }
  /// In a cylinder that ends at distances ± half from the point.
  [[nodiscard]] DepthInterval in_rod(const RayAtAxis& ray, double radius, double half) const {
    DepthInterval inside = in_cylinder(ray, radius);
    if (inside.length() <= 0.0) return {};
    if (ray.along_axis == 0.0) return std::abs(source_along_) <= half ? inside : DepthInterval{};
    const double one = (half - source_along_) / ray.along_axis;
    const double other = (-half - source_along_) / ray.along_axis;
    inside.from = std::max(inside.from, std::min(one, other));
    inside.to = std::min(inside.to, std::max(one, other));
    return inside;
  }
  /// In a ball on the axis. @param ahead distance of its centre from the point
  [[nodiscard]] DepthInterval in_ball(const RayAtAxis& ray, double radius, double ahead) const {
    return where_not_positive(ray.square, ray.to_point - ahead * ray.along_axis,
                              to_source_.squaredNorm() - 2.0 * ahead * source_along_ + ahead * ahead - radius * radius);
  }
  /// In a capsule: a cylinder of length 2 half with balls at its ends.
  [[nodiscard]] DepthInterval in_capsule(const RayAtAxis& ray, double radius, double half) const {
    return joined_intervals(joined_intervals(in_rod(ray, radius, half), in_ball(ray, radius, half)),
                            in_ball(ray, radius, -half));
  }

 private:
  Vec3 to_source_;
  double source_along_, scale_, middle_;
  RayDot along_axis_, to_point_;
};

/// Rays of a pixel along each side of it.
constexpr int kRaysAlong = 3;

/// Calls work(column, row) for the rays of a pixel.
template <class Work>
void for_rays_of(int column, int row, const Work& work) {
  const auto offset = [](int k) { return (k + 0.5) / kRaysAlong - 0.5; };
  for (int j = 0; j < kRaysAlong; ++j) {
    for (int i = 0; i < kRaysAlong; ++i) work(column + offset(i), row + offset(j));
  }
}

/// Calls work(column, row) for the pixels that a capsule may touch.
template <class Work>
void for_pixels_near(const XrayGeometry& unit, const Vec3& from, const Vec3& to, double radius, const Work& work) {
  const auto a = unit.place(from);
  const auto b = unit.place(to);
  const double margin =
      radius * unit.source_distance_mm / (std::max(1.0, std::min(a.depth_mm, b.depth_mm) - radius) * unit.pixel_mm) +
      0.75;  // of a pixel: from its middle to its corner
  const auto clipped = [&](double value) {
    return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(unit.pixels)));
  };
  const int first_row = std::max(0, clipped(std::ceil(std::min(a.row, b.row) - margin)));
  const int last_row = std::min(unit.pixels - 1, clipped(std::floor(std::max(a.row, b.row) + margin)));
  const int first_column = std::max(0, clipped(std::ceil(std::min(a.column, b.column) - margin)));
  const int last_column = std::min(unit.pixels - 1, clipped(std::floor(std::max(a.column, b.column) + margin)));
  // Pixels far from the axis in the picture are left out, which an oblique axis has many of.
  const double columns = b.column - a.column;
  const double rows = b.row - a.row;
  const double length = std::hypot(columns, rows);
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      const double off = std::abs(columns * (row - a.row) - rows * (column - a.column));
      if (off <= margin * length || length < 1.0) work(column, row);
    }
  }
}

float& sum_at(const XrayGeometry& unit, std::span<float> sums, int column, int row) {
  return sums[static_cast<std::size_t>(row) * static_cast<std::size_t>(unit.pixels) + static_cast<std::size_t>(column)];
}

/// Adds the mean of per_ray(column, row), which gives μ · length along the central ray, over the rays of the pixels
/// near an axis.
template <class PerRay>
void add_mean(const XrayGeometry& unit, const Vec3& from, const Vec3& to, double radius, std::span<float> sums,
              const PerRay& per_ray) {
  for_pixels_near(unit, from, to, radius, [&](int column, int row) {
    double total = 0.0;
    for_rays_of(column, row, [&](double x, double y) { total += per_ray(x, y); });
    if (total != 0.0) sum_at(unit, sums, column, row) += static_cast<float>(total / (kRaysAlong * kRaysAlong));
  });
}

}  // namespace

void add_tube(const XrayGeometry& unit, std::span<const Vec3> centreline_mm, double diameter_mm,
              double lumen_diameter_mm, double per_mm, std::span<float> sums) {
  const std::size_t pieces = centreline_mm.size() < 2 ? 0 : centreline_mm.size() - 1;
  const auto direction = [&](std::size_t piece) -> Vec3 {
    return (centreline_mm[piece + 1] - centreline_mm[piece]).normalized();
  };
  for (std::size_t k = 0; k < pieces; ++k) {
    const Vec3& from = centreline_mm[k];
    const Vec3& to = centreline_mm[k + 1];
    const Vec3 axis = direction(k);
    if (!axis.allFinite() || axis.isZero()) continue;
    // Planes that halve the angles between pieces, so that no part of the tube counts twice.
    const DividingPlane start(unit, from, k > 0 ? Vec3(direction(k - 1) + axis) : axis);
    const DividingPlane end(unit, to, k + 1 < pieces ? Vec3(axis + direction(k + 1)) : axis);
    const AroundAxis tube(unit, from, axis);
    const double radius = 0.5 * diameter_mm;
    const double lumen = 0.5 * lumen_diameter_mm;
    add_mean(unit, from, to, radius, sums, [&](double column, double row) {
      const RayAtAxis ray = tube.ray(column, row);
      const DepthInterval outer = tube.in_cylinder(ray, radius);
      if (outer.length() <= 0.0) return 0.0;
      const auto between_ends = [&](const DepthInterval& inside) {
        return start.part(end.part(inside, false, column, row), true, column, row).length();
      };
      return per_mm * (between_ends(outer) - (lumen > 0.0 ? between_ends(tube.in_cylinder(ray, lumen)) : 0.0));
    });
  }
}

void add_ball(const XrayGeometry& unit, const Vec3& centre_mm, double radius_mm, double per_mm, std::span<float> sums) {
  const AroundAxis ball(unit, centre_mm, unit.towards);
  add_mean(unit, centre_mm, centre_mm, radius_mm, sums, [&](double column, double row) {
    return per_mm * ball.in_ball(ball.ray(column, row), radius_mm, 0.0).length();
  });
}

void add_seed(const XrayGeometry& unit, const ShownSeed& seed, const SeedAttenuation& attenuation,
              std::span<float> sums) {
  constexpr double kWall_mm = 0.05;
  constexpr double kCoreOfDiameter = 0.625;
  constexpr double kCoreOfLength = 2.0 / 3.0;
  const double radius = 0.5 * seed.diameter_mm;
  const double half = std::max(0.0, 0.5 * seed.length_mm - radius);
  const double core_radius = kCoreOfDiameter * radius;
  const double core_half = 0.5 * kCoreOfLength * seed.length_mm;
  const AroundAxis around(unit, seed.centre_mm, seed.axis);
  const Vec3 end = half * seed.axis;
  // The seed is dense and thinner than a pixel, so that the mean of the transmission counts and not that of the length.
  for_pixels_near(unit, seed.centre_mm - end, seed.centre_mm + end, radius, [&](int column, int row) {
    const double oblique = std::sqrt(around.ray(column, row).square);
    double transmission = 0.0;
    for_rays_of(column, row, [&](double x, double y) {
      const RayAtAxis ray = around.ray(x, y);
      double sum = 0.0;
      if (around.in_cylinder(ray, radius).length() > 0.0) {
        const double wall =
            around.in_capsule(ray, radius, half).length() - around.in_capsule(ray, radius - kWall_mm, half).length();
        sum = attenuation.capsule_per_mm * wall +
              attenuation.core_per_mm * around.in_rod(ray, core_radius, core_half).length();
      }
      transmission += sum > 0.0 ? std::exp(-oblique * sum) : 1.0;
    });
    transmission /= kRaysAlong * kRaysAlong;
    if (transmission < 1.0) sum_at(unit, sums, column, row) += static_cast<float>(-std::log(transmission) / oblique);
  });
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "xray_rods.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// A part of a ray, by depth: lengths along the central ray.
struct DepthInterval {
  double from = 0.0, to = 0.0;
  [[nodiscard]] double length() const { return std::max(0.0, to - from); }
};

/// A ray from the source, whose direction has length 1 along the central ray.
struct XrayLine {
  Vec3 source, direction;
};

/// The part of a ray in an endless cylinder.
DepthInterval in_cylinder(const XrayLine& ray, const Vec3& on_axis, const Vec3& axis, double radius) {
  const Vec3 from_axis = ray.source - on_axis;
  const Vec3 across = ray.direction - ray.direction.dot(axis) * axis;
  const Vec3 start = from_axis - from_axis.dot(axis) * axis;
  const double a = across.squaredNorm();
  const double b = across.dot(start);
  const double discriminant = b * b - a * (start.squaredNorm() - radius * radius);
  if (discriminant <= 0.0 || a <= 0.0) return {};
  const double half = std::sqrt(discriminant);
  return {(-b - half) / a, (-b + half) / a};
}

DepthInterval in_ball(const XrayLine& ray, const Vec3& centre, double radius) {
  const Vec3 start = ray.source - centre;
  const double a = ray.direction.squaredNorm();
  const double b = ray.direction.dot(start);
  const double discriminant = b * b - a * (start.squaredNorm() - radius * radius);
  if (discriminant <= 0.0) return {};
  const double half = std::sqrt(discriminant);
  return {(-b - half) / a, (-b + half) / a};
}

/// The part of an interval of a ray on the inner side of a plane.
/// @param outward normal that points away from that side
DepthInterval behind_plane(DepthInterval interval, const XrayLine& ray, const Vec3& on_plane, const Vec3& outward) {
  const double speed = ray.direction.dot(outward);
  const double start = (ray.source - on_plane).dot(outward);
  if (speed == 0.0) return start <= 0.0 ? interval : DepthInterval{};
  const double crossing = -start / speed;
  if (speed > 0.0) {
    interval.to = std::min(interval.to, crossing);
  } else {
    interval.from = std::max(interval.from, crossing);
  }
  return interval;
}

DepthInterval joined(const DepthInterval& a, const DepthInterval& b) {
  if (a.length() <= 0.0) return b;
  if (b.length() <= 0.0) return a;
  return {std::min(a.from, b.from), std::max(a.to, b.to)};
}

/// The part of a ray in a capsule: a cylinder with balls at its ends.
/// @param half half the length of its axis, which is unit
DepthInterval in_capsule(const XrayLine& ray, const Vec3& centre, const Vec3& axis, double half, double radius) {
  const Vec3 offset = half * axis;
  DepthInterval inside = in_cylinder(ray, centre, axis, radius);
  inside = behind_plane(inside, ray, centre + offset, axis);
  inside = behind_plane(inside, ray, centre - offset, -axis);
  if (inside.length() <= 0.0) inside = {};
  return joined(joined(inside, in_ball(ray, centre + offset, radius)), in_ball(ray, centre - offset, radius));
}

/// Calls work(pixel's column, row) for the pixels that a capsule may touch.
template <class Work>
void for_pixels_near(const XrayGeometry& unit, const Vec3& from, const Vec3& to, double radius, const Work& work) {
  const auto a = unit.place(from);
  const auto b = unit.place(to);
  const double margin =
      radius * unit.source_distance_mm / (std::max(1.0, std::min(a.depth_mm, b.depth_mm) - radius) * unit.pixel_mm) +
      1.0;
  const auto clipped = [&](double value) {
    return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(unit.pixels)));
  };
  const int first_row = std::max(0, clipped(std::floor(std::min(a.row, b.row) - margin)));
  const int last_row = std::min(unit.pixels - 1, clipped(std::ceil(std::max(a.row, b.row) + margin)));
  const int first_column = std::max(0, clipped(std::floor(std::min(a.column, b.column) - margin)));
  const int last_column = std::min(unit.pixels - 1, clipped(std::ceil(std::max(a.column, b.column) + margin)));
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) work(column, row);
  }
}

/// Rays of a pixel along each side of it.
constexpr int kRaysAlong = 3;

/// Calls work(ray) for the rays of a pixel.
template <class Work>
void for_rays_of(const XrayGeometry& unit, int column, int row, const Work& work) {
  const Vec3 source = unit.source_mm();
  for (int j = 0; j < kRaysAlong; ++j) {
    for (int i = 0; i < kRaysAlong; ++i) {
      const auto offset = [](int k) { return (k + 0.5) / kRaysAlong - 0.5; };
      work(XrayLine{source, unit.ray(column + offset(i), row + offset(j))});
    }
  }
}

float& sum_at(const XrayGeometry& unit, std::span<float> sums, int column, int row) {
  return sums[static_cast<std::size_t>(row) * static_cast<std::size_t>(unit.pixels) + static_cast<std::size_t>(column)];
}

/// Adds the mean of `per_ray`, which gives μ · length along the central ray, over the rays of the pixels near an axis.
template <class PerRay>
void add_mean(const XrayGeometry& unit, const Vec3& from, const Vec3& to, double radius, std::span<float> sums,
              const PerRay& per_ray) {
  for_pixels_near(unit, from, to, radius, [&](int column, int row) {
    double total = 0.0;
    for_rays_of(unit, column, row, [&](const XrayLine& ray) { total += per_ray(ray); });
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
    const Vec3 end = k + 1 < pieces ? Vec3(axis + direction(k + 1)) : axis;
    const Vec3 start = k > 0 ? Vec3(axis + direction(k - 1)) : axis;
    const auto length = [&](const XrayLine& ray, double radius) {
      DepthInterval inside = in_cylinder(ray, from, axis, radius);
      if (inside.length() <= 0.0) return 0.0;
      inside = behind_plane(inside, ray, to, end);
      return behind_plane(inside, ray, from, -start).length();
    };
    add_mean(unit, from, to, 0.5 * diameter_mm, sums, [&](const XrayLine& ray) {
      const double outer = length(ray, 0.5 * diameter_mm);
      if (outer <= 0.0) return 0.0;
      return per_mm * (outer - (lumen_diameter_mm > 0.0 ? length(ray, 0.5 * lumen_diameter_mm) : 0.0));
    });
  }
}

void add_ball(const XrayGeometry& unit, const Vec3& centre_mm, double radius_mm, double per_mm, std::span<float> sums) {
  add_mean(unit, centre_mm, centre_mm, radius_mm, sums,
           [&](const XrayLine& ray) { return per_mm * in_ball(ray, centre_mm, radius_mm).length(); });
}

void add_seed(const XrayGeometry& unit, const ShownSeed& seed, const SeedAttenuation& attenuation,
              std::span<float> sums) {
  constexpr double kWall_mm = 0.05;
  constexpr double kCoreOfDiameter = 0.625;
  constexpr double kCoreOfLength = 2.0 / 3.0;
  const double radius = 0.5 * seed.diameter_mm;
  const double half = std::max(0.0, 0.5 * seed.length_mm - radius);
  const Vec3 core_end = 0.5 * kCoreOfLength * seed.length_mm * seed.axis;
  // The seed is dense and thinner than a pixel, so that the mean of the transmission counts and not that of the length.
  for_pixels_near(
      unit, seed.centre_mm - half * seed.axis, seed.centre_mm + half * seed.axis, radius, [&](int column, int row) {
        const double oblique = unit.ray(column, row).norm();
        double transmission = 0.0;
        for_rays_of(unit, column, row, [&](const XrayLine& ray) {
          const DepthInterval capsule = in_capsule(ray, seed.centre_mm, seed.axis, half, radius);
          double sum = 0.0;
          if (capsule.length() > 0.0) {
            const DepthInterval hollow = in_capsule(ray, seed.centre_mm, seed.axis, half, radius - kWall_mm);
            DepthInterval core = in_cylinder(ray, seed.centre_mm, seed.axis, kCoreOfDiameter * radius);
            core = behind_plane(core, ray, seed.centre_mm + core_end, seed.axis);
            core = behind_plane(core, ray, seed.centre_mm - core_end, -seed.axis);
            sum = attenuation.capsule_per_mm * (capsule.length() - hollow.length()) +
                  attenuation.core_per_mm * core.length();
          }
          transmission += std::exp(-oblique * sum);
        });
        transmission /= kRaysAlong * kRaysAlong;
        if (transmission < 1.0)
          sum_at(unit, sums, column, row) += static_cast<float>(-std::log(transmission) / oblique);
      });
}

}  // namespace stylet

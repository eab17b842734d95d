// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/half_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {

Mat3 free_surface_image(const Vec3& r, const SurfacePair& surface, double epsilon, const Medium& medium) {
  const double nu = medium.poisson;
  const double z = surface.at;
  const double c = surface.on;
  const Vec3& n = surface.inwards;
  const Vec3 along = r - n.dot(r) * n;  // x, y of Mindlin's paper
  const double sum = z + c;
  const double R2 = std::sqrt(along.squaredNorm() + sum * sum + epsilon * epsilon);
  const double inverse = 1.0 / R2;
  const double inverse_sum = 1.0 / (R2 + sum);
  const double cube = inverse * inverse * inverse;
  const double k = 3.0 - 4.0 * nu;
  const double m = 4.0 * (1.0 - nu) * (1.0 - 2.0 * nu);
  const double near = m * inverse * inverse_sum;  // 4(1−ν)(1−2ν) / (R₂ (R₂ + z + c))
  const double twice = 2.0 * c * z * cube;
  const double sixfold = 3.0 * twice * inverse * inverse;  // 6 c z / R₂⁵

  // Force along the surface.
  const double tangential = inverse + twice + m * inverse_sum;
  const double dyad = k * cube - sixfold - near * inverse_sum;
  // Displacement along the normal by a force along the surface, and the reverse.
  const double down = k * (z - c) * cube - sixfold * sum + near;
  const double out = k * (z - c) * cube + sixfold * sum - near;
  // Force along the normal.
  const double normal =
      (8.0 * (1.0 - nu) * (1.0 - nu) - k) * inverse + k * sum * sum * cube - twice + sixfold * sum * sum;

  const double scale = 1.0 / (16.0 * std::numbers::pi * medium.mu * (1.0 - nu));
  const Vec3 by_along = scale * (dyad * along + down * n);
  const Vec3 by_normal = scale * (out * along + (normal - tangential) * n);
  Mat3 image = by_along * along.transpose() + by_normal * n.transpose();
  image.diagonal().array() += scale * tangential;
  return image;
}

namespace {

/// 1 where both points see the same plane; 0 where their nearest surfaces are two different ones, as on both sides of a
/// fold. In that case the difference of the depths is not the distance along the normal.
double one_plane(const Vec3& r, const SurfacePair& surface) {
  constexpr double same = 0.25;
  constexpr double different = 0.5;
  const double off = std::abs(surface.inwards.dot(r) - (surface.at - surface.on));
  constexpr double rounding_mm = 1e-6;
  const double distance = r.norm() + rounding_mm;
  if (off <= same * distance) return 1.0;
  return std::max(0.0, (different * distance - off) / ((different - same) * distance));
}

}  // namespace

Mat3 surface_image(const Vec3& r, const NearSurface& at, const NearSurface& on, double epsilon, const Medium& medium) {
  double share = 0.5 * (at.share + on.share);
  if (share == 0.0) return Mat3::Zero();
  const SurfacePair pair{(at.inwards + on.inwards).normalized(), at.depth, on.depth};
  share *= one_plane(r, pair) * std::max(0.0, at.inwards.dot(on.inwards));
  if (share == 0.0) return Mat3::Zero();
  return share * free_surface_image(r, pair, epsilon, medium);
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_load.hpp"

#include "quadrature.hpp"

#include <cmath>
#include <numbers>

namespace stylet::validate {

namespace {

/// Tractions of Kelvin's solution on a plane z = const with normal −z, at r from the force [1/mm²]. Column k is for a
/// force along axis k.
/// @cite Johnson1985
Mat3 kelvin_traction(const Vec3& r, double poisson) {
  const double d = r.norm();
  const Vec3 e = r / d;
  const Vec3 n = -Vec3::UnitZ();
  const double k = 1.0 - 2.0 * poisson;
  const Mat3 turn = e * n.transpose() - n * e.transpose();
  const Mat3 T = e.dot(n) * (k * Mat3::Identity() + 3.0 * e * e.transpose()) + k * turn;
  return -T / (8.0 * std::numbers::pi * (1.0 - poisson) * d * d);
}

}  // namespace

Mat3 surface_force(const Vec3& x, const Medium& medium) {
  const double r = x.norm();
  const double z = x.z();
  const double k = 1.0 - 2.0 * medium.poisson;
  const Eigen::Vector2d flat = x.head<2>();
  const double cube = 1.0 / (r * r * r);
  const double below = 1.0 / (r + z);
  Mat3 u;
  u.topLeftCorner<2, 2>() =
      (1.0 / r + k * below) * Eigen::Matrix2d::Identity() + (cube - k * below * below / r) * flat * flat.transpose();
  u.bottomLeftCorner<1, 2>() = (z * cube + k * below / r) * flat.transpose();
  u.topRightCorner<2, 1>() = (z * cube - k * below / r) * flat;
  u(2, 2) = z * z * cube + 2.0 * (1.0 - medium.poisson) / r;
  return u / (4.0 * std::numbers::pi * medium.mu);
}

Mat3 surface_part(const Vec3& x, const Vec3& source, const Medium& medium) {
  constexpr int around = 48;
  static const std::vector<GaussPoint> outwards = gauss_legendre(48);
  Mat3 sum = Mat3::Zero();
  for (const GaussPoint& q : outwards) {
    const double rho = source.z() * q.x / (1.0 - q.x);
    const double area = q.weight * source.z() / ((1.0 - q.x) * (1.0 - q.x)) * rho * 2.0 * std::numbers::pi / around;
    for (int k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / around;
      const Vec3 y(source.x() + rho * std::cos(angle), source.y() + rho * std::sin(angle), 0.0);
      sum -= area * surface_force(x - y, medium) * kelvin_traction(y - source, medium.poisson);
    }
  }
  return sum;
}

}  // namespace stylet::validate

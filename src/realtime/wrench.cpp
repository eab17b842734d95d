// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/wrench.hpp"

#include <cmath>

namespace stylet {

Vec3 rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  Eigen::Quaterniond turn = to * from.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();  // the smaller of the two equivalent rotations
  const double sine = turn.vec().norm();
  // For small angles 2 atan2(s, c) / s → 2 / c, which avoids a division of tiny numbers.
  const double scale = sine < 1e-9 ? 2.0 / turn.w() : 2.0 * std::atan2(sine, turn.w()) / sine;
  return scale * turn.vec();
}

Eigen::Quaterniond rotated(const Eigen::Quaterniond& from, const Vec3& by) {
  const double angle = by.norm();
  // sin(x/2)/x, with its limit for small angles.
  const double scale = angle < 1e-9 ? 0.5 : std::sin(0.5 * angle) / angle;
  const Vec3 v = scale * by;
  const Eigen::Quaterniond turn(std::cos(0.5 * angle), v.x(), v.y(), v.z());
  return (turn * from).normalized();
}

}  // namespace stylet

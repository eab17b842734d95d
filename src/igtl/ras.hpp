// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace stylet::igtl {

// OpenIGTLink speaks RAS: x to the patient's right, y to anterior, z to superior. From our LPS that is half a turn
// about z, F = diag(−1, −1, 1), its own inverse. It turns the reference frame only: an axis of the needle (z along it,
// x and y of the bevel) is the same axis on both sides, so a pose R, p becomes F R, F p, not F R F. This file is the
// only place where the two frames meet.

/// Positions, forces and torques: LPS to RAS, and back. (F is a rotation, so torques turn like forces.)
[[nodiscard]] inline Vec3 ras(const Vec3& v) { return {-v.x(), -v.y(), v.z()}; }

/// A TRANSFORM's matrix: the columns of the rotation, then the position [mm], RAS.
using RasMatrix = std::array<float, 12>;

[[nodiscard]] inline RasMatrix ras_matrix(const Pose& lps) {
  const Mat3 R = lps.rotation.normalized().toRotationMatrix();
  RasMatrix m{};
  Eigen::Map<Eigen::Matrix<float, 3, 4>> columns(m.data());
  for (int k = 0; k < 3; ++k) columns.col(k) = ras(R.col(k)).cast<float>();
  columns.col(3) = ras(lps.origin).cast<float>();
  return m;
}

/// How far columns may be from length 1 and right angles: a thousand times the rounding of single precision, and less
/// than any scaling or shear that somebody meant.
inline constexpr double kRigidTolerance = 1e-3;

/// The pose that a RAS matrix says, LPS; nothing when it is no rigid motion: not finite, scaled, sheared or mirrored.
[[nodiscard]] inline std::optional<Pose> pose_of(const RasMatrix& m) {
  for (const float x : m)
    if (!std::isfinite(x)) return {};
  const Eigen::Matrix<double, 3, 4> columns = Eigen::Map<const Eigen::Matrix<float, 3, 4>>(m.data()).cast<double>();
  Mat3 R;
  R << ras(columns.col(0)), ras(columns.col(1)), ras(columns.col(2));
  if (!((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() <= kRigidTolerance)) return {};
  if (R.determinant() < 0.0) return {};
  return Pose{ras(columns.col(3)), Eigen::Quaterniond(R).normalized()};
}

}  // namespace stylet::igtl

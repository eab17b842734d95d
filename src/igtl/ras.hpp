// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace stylet::igtl {

// OpenIGTLink uses the frame RAS: x to the patient's right, y to anterior, z to superior. LPS becomes RAS by half a
// turn about z, F = diag(−1, −1, 1), which is its own inverse. F turns the reference frame only. The axes of the needle
// (z along it, x and y of the bevel) are the same in both, so a pose R, p becomes F R, F p, not F R F. This file is the
// only place where the two frames are converted.

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

/// Largest entry of |RᵀR − 1| of a rigid motion: far above the rounding of single precision, and below any
/// intended scaling or shear.
inline constexpr double kRigidTolerance = 1e-3;

/// The pose (LPS) of a RAS matrix; empty if it is no rigid motion, that is not finite, scaled, sheared or mirrored.
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

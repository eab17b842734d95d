// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>

/// Units in all of Stylet: mm, N, s, rad, MPa (= N/mm²). Frame of reference in all of Stylet: patient coordinates,
/// DICOM LPS (+x left, +y posterior, +z superior).
namespace stylet {

using Index = std::int32_t;  ///< number of a node, element or slot; -1 means "none"

using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat3 = Eigen::Matrix3d;
using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;

/// Position and orientation of a rigid body: x_world = rotation * x_local + origin.
struct Pose {
  Vec3 origin = Vec3::Zero();                                    ///< [mm] LPS, position of the local origin
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< local to LPS; local z is the needle's axis
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/probe/capsule.hpp"
#include "stylet/probe/wall_compliance.hpp"

#include <memory>
#include <span>

namespace stylet {

/// The forces between a probe and a wall at one pose.
struct ProbePress {
  Vec3 force_N = Vec3::Zero();     ///< LPS, of the tissue on the probe
  Vec3 moment_Nmm = Vec3::Zero();  ///< LPS, of the tissue on the probe about Capsule::centre_mm
  int touching = 0;                ///< number of points that press
  double penetration_mm = 0.0;     ///< largest depth of a point in the probe
  double distance_mm = 0.0;        ///< largest distance from the probe of a point that presses
  int linearisations = 0;          ///< of the gap
  int sweeps = 0;                  ///< of Gauss–Seidel over all points
};

/// Frictionless unilateral contact of a rigid probe with the points of a wall: for each point
///   g ≥ 0, λ ≥ 0, λ g = 0,
/// where g is its gap (Capsule::gap) at its moved place and λ the force on it along the gap's normal. The gap is
/// linearised at the moved points, and the linear problem is solved by projected Gauss–Seidel from the last forces.
///
/// press() neither allocates nor waits. docs/theory/probe.md has the derivation.
class ProbeContact {
 public:
  explicit ProbeContact(std::shared_ptr<const WallCompliance> wall);

  /// Makes a pose the reference: the mesh was drawn with the probe there, so displacements are counted from this pose.
  /// The tissue's state without a probe is unknown then. It is taken such that the wall bears the same forces at every
  /// pose as if the mesh had been drawn without a probe, so the probe's motion moves the tissue both ways.
  void set_reference(const Capsule& probe);

  /// Finds the forces at a pose. Repeated calls start from the last forces.
  ProbePress press(const Capsule& probe);
  /// Forgets the forces, so that the next press() depends on its pose only.
  void release();

  /// Force [N] on every point, along its normal.
  [[nodiscard]] std::span<const double> forces() const {
    return {lambda_.data(), static_cast<std::size_t>(lambda_.size())};
  }
  /// Gap [mm] of every point at its moved place after the last press().
  [[nodiscard]] std::span<const double> gaps() const { return {gap_.data(), static_cast<std::size_t>(gap_.size())}; }
  /// Unit vector of the force on a point, out of the probe.
  [[nodiscard]] Vec3 normal(int point) const { return normal_.col(point); }
  /// Displacement [mm] of a point under the forces.
  [[nodiscard]] Vec3 displacement_of_point(int point) const { return moved_.segment<3>(3 * point); }

  /// Displacement [mm] LPS of all nodes of the mesh (3 × nodes) from the reference, or from the state without a probe
  /// if there is no reference. Single precision.
  void displacement(Eigen::Ref<Eigen::Matrix3Xf> out) const;
  /// Displacement [mm] LPS of some nodes of the mesh (3 × nodes asked for).
  void displacement(std::span<const Index> nodes, Eigen::Ref<Eigen::Matrix3Xf> out) const;

  [[nodiscard]] const WallCompliance& wall() const { return *wall_; }

 private:
  /// Rows and columns of the points that may come into contact.
  struct Linear {
    MatX compliance;          ///< (w × w) along the normals [mm/N]; the first `count` rows and columns are in use
    VecX gap;                 ///< (w) [mm]
    std::vector<int> points;  ///< (w)
    int count = 0;
  };

  void move_points();
  [[nodiscard]] double find_gaps(const Capsule& probe);
  void linearise();
  int sweep();
  [[nodiscard]] Eigen::Vector3f load(int point) const;

  std::shared_ptr<const WallCompliance> wall_;
  VecX lambda_;                      ///< (w) [N]
  Eigen::Matrix3Xd normal_;          ///< (3 × w) of the forces
  Eigen::Matrix3Xd surface_normal_;  ///< (3 × w) at the moved points
  VecX gap_;                         ///< (w) [mm]
  VecX moved_;                       ///< (3w) [mm] displacement under the forces
  Linear linear_;
  Eigen::Matrix3Xd held_;  ///< (3 × w) [N] forces at the reference
};

}  // namespace stylet

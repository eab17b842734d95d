// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/moment.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <span>
#include <vector>

namespace stylet {

/// The displacement right beside a needle that linear elements cannot represent: that of the needle's forces in an
/// unbounded medium (Kelvinlets), minus its linear interpolation in the element. It ends at kReach_mm from a force.
/// Nodes get their part of the field when it is first asked for, since a picture needs few of them. For one thread.
class NeedleField {
 public:
  static constexpr double kReach_mm = 12.0;

  explicit NeedleField(const TetMesh& mesh);

  /// Replaces the forces. Allocates when there are more than in any earlier call beyond 64.
  void set(std::span<const ShownForce> forces);
  [[nodiscard]] bool is_empty() const { return forces_.empty(); }
  /// Whether the field moves a corner of this tetrahedron.
  [[nodiscard]] bool reaches(Index tet) const;

  /// The field's part of a node's displacement [mm] LPS.
  [[nodiscard]] Vec3 at_node(Index node);
  /// Displacement of an undeformed point [mm] LPS by the forces.
  [[nodiscard]] Vec3 at(const Vec3& x) const;
  /// Displacement [mm] LPS of an undeformed point that the mesh does not show: at() minus its interpolation.
  /// @param weights of the tetrahedron's corners at x (4)
  [[nodiscard]] Vec3 beside_mesh(Index tet, const Vec4& weights, const Vec3& x);

 private:
  enum class State : std::uint8_t { far, unknown, known };

  const TetMesh* mesh_;
  std::vector<ShownForce> forces_;
  Eigen::Matrix3Xf nodes_;    ///< [mm] the field's part of the displacement where state_ is known
  std::vector<State> state_;  ///< (nodes) of their column of nodes_
};

}  // namespace stylet

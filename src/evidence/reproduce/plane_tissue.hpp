// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <vector>

namespace stylet::reproduce {

using Vec2 = Eigen::Vector2d;

/// The tissue of the paper's figure 5: a square in plane strain, unit thickness, linear triangles, its left side held.
struct PlaneTissue {
  static constexpr double kSide_mm = 100.0;
  static constexpr double kYoung_MPa = 0.02;
  static constexpr double kPoisson = 0.45;

  std::vector<Vec2> nodes;                      ///< [mm]
  std::vector<std::array<Index, 3>> triangles;  ///< anticlockwise
  Index held = 0;                               ///< nodes 0 … held − 1 are held

  [[nodiscard]] Index dofs() const { return 2 * (static_cast<Index>(nodes.size()) - held); }
  /// First degree of freedom of a node, −1 where it is held.
  [[nodiscard]] Index first_dof(Index node) const { return node < held ? -1 : 2 * (node - held); }
};

/// A grid of deep × across rectangles, each cut into two triangles; deep counts from the side that is held.
/// 2 deep (across + 1) degrees of freedom.
PlaneTissue plane_tissue(int deep, int across);

/// Stiffness of one triangle: A Bᵀ D B [N/mm] (6 × 6), x and y of each corner in turn. A: area, B: strain per corner
/// displacement, D: plane strain.
Eigen::Matrix<double, 6, 6> triangle_stiffness(const PlaneTissue& tissue, const std::array<Index, 3>& triangle);

/// Stiffness on the free degrees of freedom [N/mm], dense, both triangles.
MatX stiffness(const PlaneTissue& tissue);

/// The change of the stiffness when elements give way to others.
struct StiffnessChange {
  std::vector<Index> dofs;  ///< (k) degrees of freedom that ΔK belongs to, ascending
  MatX values;              ///< ΔK [N/mm] (k × k)
};

/// Puts a node on the edge that the two triangles of a cell in the middle share: two triangles become four; ΔK has the
/// four corners and the new node, 10 × 10.
/// @param tissue changed: the new node is the last one
StiffnessChange add_node_in_the_middle(PlaneTissue& tissue);

}  // namespace stylet::reproduce

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <vector>

namespace stylet::reproduce {

using Vec2 = Eigen::Vector2d;

/// The tissue of the paper's figure 5: a square in plane strain, of unit thickness, made of linear triangles, with its
/// left side held.
struct PlaneTissue {
  static constexpr double kSide_mm = 100.0;
  static constexpr double kYoung_MPa = 0.02;
  static constexpr double kPoisson = 0.45;

  std::vector<Vec2> nodes;                      ///< [mm]
  std::vector<std::array<Index, 3>> triangles;  ///< anticlockwise
  Index held = 0;                               ///< nodes 0 … held − 1 are held

  [[nodiscard]] Index dofs() const { return 2 * (static_cast<Index>(nodes.size()) - held); }
  /// First degree of freedom of a node; −1 if it is held.
  [[nodiscard]] Index first_dof(Index node) const { return node < held ? -1 : 2 * (node - held); }
};

/// Makes a grid of deep × across rectangles, each divided into two triangles. `deep` counts from the held side. The
/// tissue has 2 deep (across + 1) degrees of freedom.
PlaneTissue plane_tissue(int deep, int across);

/// Stiffness of one triangle: A Bᵀ D B [N/mm] (6 × 6), with x and y of each corner in turn. A is the area, B the strain
/// per corner displacement, D the elasticity matrix of plane strain.
Eigen::Matrix<double, 6, 6> triangle_stiffness(const PlaneTissue& tissue, const std::array<Index, 3>& triangle);

/// Stiffness on the free degrees of freedom [N/mm], as a full dense matrix.
MatX stiffness(const PlaneTissue& tissue);

/// The change of the stiffness when elements are replaced by others.
struct StiffnessChange {
  std::vector<Index> dofs;  ///< (k) degrees of freedom that ΔK changes, ascending
  MatX values;              ///< ΔK [N/mm] (k × k)
};

/// Adds a node on the common edge of the two triangles of a cell in the middle, so that two triangles become four. ΔK
/// covers the four corners and the new node and is 10 × 10.
/// @param tissue is changed; the new node is its last
StiffnessChange add_node_in_the_middle(PlaneTissue& tissue);

}  // namespace stylet::reproduce

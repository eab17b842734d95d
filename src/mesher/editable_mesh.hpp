// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tetrahedraliser.hpp"

#include <span>

namespace stylet::meshing {

/// Limits of acceptable elements; an element at one of these limits has the quality 1.
inline constexpr double kSmallestAngle = 12.0;  // [deg] dihedral angle
inline constexpr double kLargestAngle = 165.0;  // [deg] dihedral angle

inline constexpr double kSmallestRatio = 0.15;  // radius ratio

/// Quality of a tetrahedron: the least of smallest dihedral angle / 12°, (180° − largest dihedral angle) / 15° and
/// radius ratio / 0.15. The radius ratio 3 r_in / r_circ also tells needle-shaped elements from good ones. 0 for flat
/// or inverted elements.
double tet_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// A tetrahedral mesh for local changes, with lists of the tetrahedra around each node.
class EditableMesh {
 public:
  explicit EditableMesh(RawMesh mesh);

  /// A tetrahedron with its region.
  struct Tet {
    std::array<Index, 4> nodes;
    int label;  ///< region, 0 = deleted
  };

  std::vector<Vec3> nodes;  ///< [mm] LPS
  std::vector<Tet> tets;
  std::vector<std::vector<Index>> around;  ///< (nodes) tetrahedra that are not deleted
  std::vector<bool> on_outside;            ///< (nodes) whether the node is on the outer boundary

  [[nodiscard]] bool alive(Index t) const { return tets[t].label != 0; }
  [[nodiscard]] double quality(Index t) const { return quality(tets[t].nodes); }
  [[nodiscard]] double quality(const std::array<Index, 4>& n) const {
    return tet_quality(nodes[n[0]], nodes[n[1]], nodes[n[2]], nodes[n[3]]);
  }
  /// Worst quality of the tetrahedra around a node.
  [[nodiscard]] double quality_around(Index node) const;
  /// Worst quality of all tetrahedra.
  [[nodiscard]] double worst_quality() const;
  /// Labels of the regions that meet at a node, ascending; the first is 0 when the node is on the outer boundary.
  [[nodiscard]] std::vector<int> labels_at(Index node) const;
  /// Tetrahedra that contain both nodes.
  [[nodiscard]] std::vector<Index> around_edge(Index a, Index b) const;
  /// Whether an edge of the mesh lies on the surface of a region.
  [[nodiscard]] bool on_surface(Index a, Index b) const;
  /// The tetrahedron on the other side of a face, or -1.
  [[nodiscard]] Index across(Index tet, const std::array<Index, 3>& face) const;

  /// Replaces the tetrahedra `dead` by the tetrahedra `born`.
  void replace(std::span<const Index> dead, std::span<const Tet> born);

  /// The tetrahedra that are not deleted, with the nodes they use, renumbered.
  [[nodiscard]] RawMesh result() const;
};

}  // namespace stylet::meshing

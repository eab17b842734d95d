// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tetrahedraliser.hpp"

#include <span>

namespace stylet::meshing {

/// Acceptable dihedral angles; quality 1 is just acceptable.
inline constexpr double kSmallestAngle = 12.0;  // [deg]
inline constexpr double kLargestAngle = 165.0;  // [deg]

inline constexpr double kSmallestRatio = 0.15;  // radius ratio

/// How good a tetrahedron is: the least of smallest dihedral angle / 12°, (180° − largest) / 15° and radius ratio /
/// 0.15 (3 r_in / r_circ, which also tells needles from good elements); 0 when flat or inverted.
double tet_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// A tetrahedral mesh under local changes: knows the tetrahedra around each node.
class EditableMesh {
 public:
  explicit EditableMesh(RawMesh mesh);

  struct Tet {
    std::array<Index, 4> nodes;
    int label;  ///< region, 0 = deleted
  };

  std::vector<Vec3> nodes;  ///< [mm] LPS
  std::vector<Tet> tets;
  std::vector<std::vector<Index>> around;  ///< (nodes) living tetrahedra
  std::vector<bool> on_outside;            ///< (nodes) lies on the outer boundary

  [[nodiscard]] bool alive(Index t) const { return tets[t].label != 0; }
  [[nodiscard]] double quality(Index t) const { return quality(tets[t].nodes); }
  [[nodiscard]] double quality(const std::array<Index, 4>& n) const {
    return tet_quality(nodes[n[0]], nodes[n[1]], nodes[n[2]], nodes[n[3]]);
  }
  /// Worst quality around a node.
  [[nodiscard]] double quality_around(Index node) const;
  /// Worst quality of all.
  [[nodiscard]] double worst_quality() const;
  /// Regions that meet at a node, ascending; 0 first where it lies on the outer boundary.
  [[nodiscard]] std::vector<int> labels_at(Index node) const;
  /// Living tetrahedra at both nodes.
  [[nodiscard]] std::vector<Index> around_edge(Index a, Index b) const;
  /// True when an edge of the mesh lies on the surface of a region.
  [[nodiscard]] bool on_surface(Index a, Index b) const;
  /// The other living tetrahedron at a face, or -1.
  [[nodiscard]] Index across(Index tet, const std::array<Index, 3>& face) const;

  /// Deletes tetrahedra and adds others in their place.
  void replace(std::span<const Index> dead, std::span<const Tet> born);

  /// Living tetrahedra and the nodes they use, numbered in order.
  [[nodiscard]] RawMesh result() const;
};

}  // namespace stylet::meshing

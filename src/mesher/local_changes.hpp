// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"
#include "editable_mesh.hpp"

namespace stylet::meshing {

/// Local changes of a few elements that improve the worst quality among them (Freitag & Ollivier-Gooch 1997; Klingner &
/// Shewchuk 2008). Each returns true when it has changed the mesh. Surfaces between regions keep their places within
/// `slack`.
class LocalChanges {
 public:
  /// @param slack largest distance between a surface node and its surface / shortest edge at the node
  LocalChanges(EditableMesh& mesh, const Anatomy& anatomy, double slack)
      : mesh_(mesh), anatomy_(anatomy), slack_(slack) {}

  /// Moves a node to where the worst tetrahedron around it is best; surface nodes move along their surfaces.
  bool move(Index node);
  /// Replaces the tetrahedra around an edge by the best triangulation of the ring of nodes around it. An edge on the
  /// surface between two regions is swapped where the surface is flat enough.
  bool remove_edge(Index a, Index b);
  /// Replaces two tetrahedra with a common face by three around the line between their apexes.
  bool remove_face(Index tet, int local);

 private:
  [[nodiscard]] double shortest_edge(Index node) const;
  [[nodiscard]] double off_surface(const std::vector<int>& labels, const Vec3& p) const;

  EditableMesh& mesh_;
  const Anatomy& anatomy_;
  double slack_;
};

/// Improves the worst tetrahedra first, until all have at least the quality `goal` or no change helps.
void improve(EditableMesh& mesh, const Anatomy& anatomy, double goal);

}  // namespace stylet::meshing

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"
#include "editable_mesh.hpp"

namespace stylet::meshing {

/// Changes of a few elements that raise the worst quality among them (Freitag & Ollivier-Gooch 1997; Klingner &
/// Shewchuk 2008). Each returns true when it changed the mesh. Surfaces between regions stay where they are, within
/// `slack`.
class LocalChanges {
 public:
  /// @param slack how far a surface node may leave its surface, times the shortest edge at the node
  LocalChanges(EditableMesh& mesh, const Anatomy& anatomy, double slack)
      : mesh_(mesh), anatomy_(anatomy), slack_(slack) {}

  /// Moves a node to where its worst tetrahedron is best; surface nodes along their surfaces.
  bool move(Index node);
  /// Replaces the tetrahedra around an edge by the best triangulation of the ring around it. Edges on the surface
  /// between two regions are swapped where the surface is flat enough.
  bool remove_edge(Index a, Index b);
  /// Replaces two tetrahedra by three around the edge between their apexes.
  bool remove_face(Index tet, int local);

 private:
  [[nodiscard]] double shortest_edge(Index node) const;
  [[nodiscard]] double off_surface(const std::vector<int>& labels, const Vec3& p) const;

  EditableMesh& mesh_;
  const Anatomy& anatomy_;
  double slack_;
};

/// Works through the worst tetrahedra until all have `goal` quality or no change helps any more.
void improve(EditableMesh& mesh, const Anatomy& anatomy, double goal);

}  // namespace stylet::meshing

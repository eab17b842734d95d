// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_tree.hpp"
#include "stylet/geom/topology.hpp"

#include <optional>

namespace stylet {

/// A material point: the tetrahedron that contains it and its barycentric weights there (sum 1).
struct MaterialPoint {
  Index tet = -1;
  Vec4 weights = Vec4::Zero();
};

/// The point where a straight path crosses a face: an outer face of the mesh or a face between two regions.
struct Crossing {
  double t = 0.0;  ///< path parameter, 0…1; the point is from + t (to - from)
  Index tet = -1;  ///< tetrahedron that the path leaves, or for first_entry() the one that it enters
  int local = -1;  ///< the face of `tet` that the path crosses lies opposite this local vertex
};

/// Finds the tetrahedron that contains a point. It walks from neighbour to neighbour; without a hint, a tree of
/// bounding boxes gives the start. No member function allocates. A point on a face, edge or node belongs to several
/// tetrahedra; the direction of travel decides between them.
class Locator {
 public:
  Locator(const TetMesh& mesh, const Topology& topology);  ///< keeps references: both must outlive the locator

  /// The tetrahedron that contains x. Weights are not below -1e-12. Empty outside the mesh.
  /// @param x [mm] LPS
  /// @param hint number of a tetrahedron near x, or -1
  /// @param travel where several tetrahedra contain x, the one into which this direction leads from x is preferred;
  ///   zero: any of them
  [[nodiscard]] std::optional<MaterialPoint> find(const Vec3& x, Index hint = -1,
                                                  const Vec3& travel = Vec3::Zero()) const;

  /// Barycentric weights of x with respect to tetrahedron t (4). x may lie outside it.
  [[nodiscard]] Vec4 weights(Index t, const Vec3& x) const;

  /// Walks along the segment from `from`, which lies in tetrahedron `start`, to `to`, and stops at the first face
  /// behind which the region changes or the mesh ends. Regions that the path touches only in a point or an edge are
  /// passed over, and a path within an interface stays in the region where it started. Where the mesh ends at an edge
  /// or node, the face of the result may be an outer face of an element of another region that has this edge or node.
  /// @param end receives the material point at `to` if the result is empty; unchanged otherwise
  /// @return empty when the path reaches `to` first
  [[nodiscard]] std::optional<Crossing> first_crossing(const Vec3& from, Index start, const Vec3& to,
                                                       MaterialPoint& end) const;

  /// The first outer face through which the segment from `from` (outside the mesh) to `to` enters the mesh;
  /// Crossing::tet is the tetrahedron behind that face. Faces that the segment meets from inside are ignored.
  [[nodiscard]] std::optional<Crossing> first_entry(const Vec3& from, const Vec3& to) const;

  /// Outward unit normal of the face of tetrahedron t opposite local vertex `local`.
  [[nodiscard]] Vec3 face_normal(Index t, int local) const;

  [[nodiscard]] const TetMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const Topology& topology() const { return *topology_; }

 private:
  const TetMesh* mesh_;
  const Topology* topology_;
  TetTree tree_;
};

}  // namespace stylet

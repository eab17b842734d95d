// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_tree.hpp"
#include "stylet/geom/topology.hpp"

#include <optional>

namespace stylet {

/// A material point: a tetrahedron and the barycentric weights in it (sum 1).
struct MaterialPoint {
  Index tet = -1;
  Vec4 weights = Vec4::Zero();
};

/// Where a straight path meets the outer boundary or an inner face.
struct Crossing {
  double t = 0.0;  ///< path parameter, point = from + t (to - from), 0…1
  Index tet = -1;  ///< tetrahedron left (inner crossings, exits) or entered (entries from outside)
  int local = -1;  ///< face of `tet` that is crossed, opposite this local vertex
};

/// Finds tetrahedra by walking from neighbour to neighbour, with a bounding-box tree as the start where no hint is
/// given. No call allocates. Ties (a point on a face, edge or node) are broken by the direction of travel.
class Locator {
 public:
  Locator(const TetMesh& mesh, const Topology& topology);  ///< keeps references: both must outlive the locator

  /// The tetrahedron that contains x; weights may be as low as -1e-12. Empty outside the mesh.
  /// @param x [mm] LPS
  /// @param hint a tetrahedron nearby, or -1
  /// @param travel direction that breaks ties: the tetrahedron containing x + 0·travel is preferred; zero = any
  [[nodiscard]] std::optional<MaterialPoint> find(const Vec3& x, Index hint = -1,
                                                  const Vec3& travel = Vec3::Zero()) const;

  /// Weights of x in tetrahedron t, not checked to lie inside (4).
  [[nodiscard]] Vec4 weights(Index t, const Vec3& x) const;

  /// Walks from `from`, which lies in tetrahedron `start`, towards `to`; stops at the first face across which the
  /// region changes or the mesh ends. Empty when `to` is reached first; `end` is then (and only then) where `to` lies.
  /// A region touched at a point or an edge only is passed over, and a path within an interface stays in the region
  /// it is in. Where the mesh ends at an edge or node, the face may be an outer face of another region's element there.
  [[nodiscard]] std::optional<Crossing> first_crossing(const Vec3& from, Index start, const Vec3& to,
                                                       MaterialPoint& end) const;

  /// First outer face that the segment from `from` (outside the mesh) to `to` enters; Crossing::tet is the tetrahedron
  /// behind that face. Faces met from inside are ignored.
  [[nodiscard]] std::optional<Crossing> first_entry(const Vec3& from, const Vec3& to) const;

  /// Outward unit normal of a face of tetrahedron t.
  [[nodiscard]] Vec3 face_normal(Index t, int local) const;

  [[nodiscard]] const TetMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const Topology& topology() const { return *topology_; }

 private:
  const TetMesh* mesh_;
  const Topology* topology_;
  TetTree tree_;
};

}  // namespace stylet

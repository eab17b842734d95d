// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <limits>
#include <memory>
#include <vector>

namespace stylet {

/// The nearest surface of a set, as a plane.
struct NearSurface {
  double depth = std::numeric_limits<double>::infinity();  ///< [mm] distance of the place from the surface
  Vec3 inwards = Vec3::UnitZ();                            ///< unit normal, into the tissue
  /// Share 0 … 1 of the surface's image that counts; it fades out some elements away from the surface.
  double share = 0.0;
};

/// Distance to a set of triangles, with a normal that turns continuously along them.
class SurfaceDistance {
 public:
  /// @param triangles corners ordered so that the normal points out of the tissue; empty: no surface
  /// @param values (triangles) a quantity on the triangles, or empty
  SurfaceDistance(const std::vector<Vec3>& nodes, std::vector<std::array<Index, 3>> triangles,
                  const std::vector<double>& values = {});
  ~SurfaceDistance();
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;

  /// The given quantity at the nearest point of the surface; at a node it is the mean over the node's triangles,
  /// weighted by their areas.
  struct Value {
    double value = 0.0;
    int triangle = -1;  ///< triangle that has the nearest point
  };
  /// The surface nearest to x [mm].
  /// @param value output: the quantity at the nearest point; may be null
  [[nodiscard]] NearSurface nearest(const Vec3& x, Value* value = nullptr) const;
  /// The nearest surface that faces another one, as the two faces of a thin layer do. A surface that faces it at an
  /// angle counts as further away, by the cosine between the normals, so that nothing jumps as x moves.
  /// @param inwards unit normal of the other surface, into the tissue
  [[nodiscard]] NearSurface opposite(const Vec3& x, const Vec3& inwards, Value* value = nullptr) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <limits>
#include <memory>
#include <vector>

namespace stylet {

/// The nearest surface of one kind, as a plane.
struct NearSurface {
  double depth = std::numeric_limits<double>::infinity();  ///< [mm]
  Vec3 inwards = Vec3::UnitZ();                            ///< unit normal, into the tissue
  double share = 0.0;  ///< 0…1: how much of its image counts; fades out some elements away from it
};

/// Distance to a set of triangles, with a normal that turns continuously along them.
class SurfaceDistance {
 public:
  /// @param triangles corners ordered so that the normal points out of the tissue; empty = nothing near
  /// @param values (triangles) of some quantity, or none
  SurfaceDistance(const std::vector<Vec3>& nodes, std::vector<std::array<Index, 3>> triangles,
                  const std::vector<double>& values = {});
  ~SurfaceDistance();
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;

  /// The quantity at the nearest point; at a node it is the mean of the triangles there, weighted by their areas.
  struct Value {
    double value = 0.0;
    int triangle = -1;  ///< that has the nearest point
  };
  /// @param value written, if it is asked for
  [[nodiscard]] NearSurface nearest(const Vec3& x, Value* value = nullptr) const;
  /// The nearest surface that faces another one, as in a layer one face does the other. What faces it askew counts as
  /// further away, by the cosine between the normals: nothing jumps as x moves.
  /// @param inwards unit normal of the other surface, into the tissue
  [[nodiscard]] NearSurface opposite(const Vec3& x, const Vec3& inwards, Value* value = nullptr) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace stylet

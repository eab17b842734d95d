// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"
#include "stylet/imaging/xray_geometry.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The outer faces and the faces between regions of a mesh, and how they change the attenuation of a ray. A ray that
/// leaves region A for region B at depth z adds (μ_A − μ_B) z to its sum of μ · length, which needs no order of faces.
class XraySurfaces {
 public:
  /// @param mesh is not kept
  XraySurfaces(const TetMesh& mesh, const FluoroscopySettings& settings);

  /// Adds the attenuation of the deformed mesh along the rays of a picture. The sums are of μ times length along the
  /// central ray: an oblique ray is longer by the length of XrayGeometry::ray(). Does not allocate.
  /// @param displacement (3 × nodes of the mesh) [mm] LPS
  /// @param sums (pixels²) row by row from the top
  void add(const XrayGeometry& unit, const Eigen::Matrix3Xf& displacement, std::span<float> sums);

 private:
  /// A corner of faces in the picture.
  struct Corner {
    double column, row;
    double nearer;  ///< 1 − d / depth, where d is the distance of source and centre; linear on a plane in the picture
  };
  struct Triangle {
    std::array<Index, 3> corners{};  ///< numbers of corners, counter-clockwise seen from outside
    double step_per_mm = 0.0;        ///< μ inside less μ outside
    Index bone = -1;                 ///< number of the first of three normals, if it bounds a bone
  };
  struct Vertex {
    double column = 0.0, row = 0.0, nearer = 0.0, shell = 0.0;
  };

  void add_triangle(const Triangle& triangle, const XrayGeometry& unit, std::span<float> sums);
  [[nodiscard]] double shell_at(const Triangle& triangle, int corner, const XrayGeometry& unit) const;

  double cortex_ = 0.0;          ///< μ · length of the cortex where a ray meets it at a right angle
  std::vector<Index> nodes_;     ///< node of the mesh of each corner
  std::vector<Vec3> at_rest_;    ///< [mm] LPS of each corner
  std::vector<Corner> corners_;  ///< in the picture that is being made
  std::vector<Triangle> triangles_;
  std::vector<Vec3> bone_normals_;  ///< outward unit normals at the corners of bones' faces, at rest: bones are held
};

}  // namespace stylet

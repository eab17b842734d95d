// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/contours.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet::reproduce {

/// A contour of the organ, and which of its points remain after culling.
struct CulledContour {
  std::vector<Vec3> points;  ///< [mm] LPS, in order
  std::vector<bool> kept;    ///< (points) whether the point remains
};

/// The paper's figure 2: kept and dropped contour points, the organ's surface in the mesh, and a segment of the needle.
struct Figure2 {
  std::string organ;
  double cull_mm = 0.0;  ///< a point is dropped if the contour without it passes nearer to it than this
  std::vector<CulledContour> contours;

  std::vector<Vec3> surface_points;                     ///< [mm] LPS
  std::vector<std::array<Index, 3>> surface_triangles;  ///< corners, with outward normals

  /// One segment of the tetrahedral needle; its axis is local z.
  struct Segment {
    std::vector<Vec3> points;  ///< [mm]
    std::vector<std::array<Index, 4>> tets;
  };
  Segment symmetric;   ///< the segment that is used; symmetric, as the paper requires
  Segment asymmetric;  ///< the simpler segment, which bends to one side

  [[nodiscard]] std::size_t points() const;
  [[nodiscard]] std::size_t points_kept() const;
};

/// Makes the figure.
/// @param contours contours of the patient; the organ is its target (the prostate)
/// @param mesh mesh made from these contours
Figure2 make_figure2(const ContourSet& contours, const TetMesh& mesh, double cull_mm);

}  // namespace stylet::reproduce

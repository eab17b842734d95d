// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/contours.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet::reproduce {

/// A contour of the organ, and which of its points the mesher keeps.
struct CulledContour {
  std::vector<Vec3> points;  ///< [mm] LPS, in order
  std::vector<bool> kept;    ///< (points)
};

/// The paper's figure 2: contour points kept and dropped, the organ's surface in the mesh, a segment of the needle.
struct Figure2 {
  std::string organ;
  double cull_mm = 0.0;  ///< points nearer than this to the contour without them are dropped
  std::vector<CulledContour> contours;

  std::vector<Vec3> surface_points;                     ///< [mm] LPS
  std::vector<std::array<Index, 3>> surface_triangles;  ///< outward

  /// One segment of the tetrahedral needle, local z its axis.
  struct Segment {
    std::vector<Vec3> points;  ///< [mm]
    std::vector<std::array<Index, 4>> tets;
  };
  Segment symmetric;   ///< the one that is used, of the kind the paper asks for
  Segment asymmetric;  ///< the simpler one, which bends to one side

  [[nodiscard]] std::size_t points() const;
  [[nodiscard]] std::size_t points_kept() const;
};

/// @param contours the patient; the organ is its target (the prostate)
/// @param mesh made from them
Figure2 make_figure2(const ContourSet& contours, const TetMesh& mesh, double cull_mm);

}  // namespace stylet::reproduce

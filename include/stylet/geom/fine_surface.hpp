// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <span>
#include <vector>

namespace stylet {

/// A point of a surface, between up to three given ones: they carry it along as they move.
struct SurfacePoint {
  std::array<Index, 3> node{-1, -1, -1};  ///< of the given points, −1 = unused
  std::array<double, 3> weight{};         ///< sum 1
};

/// How fine triangles are near a line, and how soon they get coarser away from it.
struct Fineness {
  double finest_mm = 0.2;  ///< edges on the line
  double growth = 0.35;    ///< edges at a distance are this share of it, where that is more
  double reach_mm = 12.0;  ///< edges further away stay as they are
};

/// Triangles of surfaces, finer where lines pass through or near them than they were given. The surfaces keep their
/// shape: every new point lies on a triangle that was given. They stay closed where they were.
struct FineSurface {
  std::vector<SurfacePoint> points;             ///< the given ones come first, under their own numbers
  std::vector<Vec3> positions;                  ///< (points) [mm]
  std::vector<std::array<Index, 3>> triangles;  ///< corners, in the sense of rotation they were given with
  std::vector<int> patch;                       ///< (triangles) that of the triangle each is a piece of
};

using LineSegment = std::array<Vec3, 2>;  ///< both ends [mm]

/// @param points [mm] corners of the triangles
/// @param patch one number a triangle, any; a triangle's pieces have it as well
/// @param lines where to refine; each gets a point wherever it goes through a triangle
FineSurface refine_surface(std::span<const Vec3> points, std::vector<std::array<Index, 3>> triangles,
                           std::vector<int> patch, std::span<const LineSegment> lines, const Fineness& fineness = {});

}  // namespace stylet

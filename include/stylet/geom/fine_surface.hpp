// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <span>
#include <vector>

namespace stylet {

/// A point of a surface, interpolated between up to three of the given points and moving with them.
struct SurfacePoint {
  std::array<Index, 3> node{-1, -1, -1};  ///< numbers of given points, −1 = unused
  std::array<double, 3> weight{};         ///< weights of these points, sum 1
};

/// Longest allowed edge of a triangle, as a function of its distance to the nearest line:
/// max(finest_mm, growth × distance).
struct Fineness {
  double finest_mm = 0.2;  ///< longest edge at the line; smaller values give more triangles
  double growth = 0.35;    ///< longest edge per distance to the line; smaller values give more triangles
  double reach_mm = 12.0;  ///< edges further from every line than this keep their length
};

/// A triangulated surface that has been refined near lines. Every new point lies on one of the given triangles, so the
/// surface keeps its shape, and it stays closed where it was closed.
struct FineSurface {
  std::vector<SurfacePoint> points;  ///< the given points come first, with unchanged numbers
  std::vector<Vec3> positions;       ///< (points) [mm] LPS, position of each point
  /// Numbers of the corners, in the same sense of rotation as in the given triangle.
  std::vector<std::array<Index, 3>> triangles;
  std::vector<int> patch;  ///< (triangles) patch number of the given triangle of which this triangle is a part
};

using LineSegment = std::array<Vec3, 2>;  ///< start and end of a straight line [mm] LPS

/// Refines triangulated surfaces near lines.
/// @param points [mm] LPS, corners of the triangles
/// @param patch (triangles) any number; the parts of a triangle inherit its number
/// @param lines lines near which to refine; a point is added wherever a line passes through a triangle
FineSurface refine_surface(std::span<const Vec3> points, std::vector<std::array<Index, 3>> triangles,
                           std::vector<int> patch, std::span<const LineSegment> lines, const Fineness& fineness = {});

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace stylet::detail {

/// Two edges of a polygon that cross: edge k runs from point k to point k+1.
struct Crossing {
  std::size_t first_edge = 0;
  std::size_t second_edge = 0;
  Eigen::Vector2d point;  ///< [mm]
};

/// Looks for a proper crossing of two edges of a closed polygon. Edges that touch or run along each other are no
/// crossing: clinical contours cut holes out of a region by an edge that goes in and the same way out again
/// ("keyhole"). Sweep over edges sorted along the longer axis of the polygon; O(n log n + pairs whose intervals
/// overlap).
/// @param points [mm] (n) the polygon, first point not repeated
/// @param tolerance [mm] edges that reach across each other by less only touch (coordinates are rounded in files)
std::optional<Crossing> find_self_crossing(const std::vector<Eigen::Vector2d>& points, double tolerance);

}  // namespace stylet::detail

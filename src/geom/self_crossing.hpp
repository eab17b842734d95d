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

/// Finds a proper crossing of two edges of a closed polygon, if there is one. Edges that touch or run along each other
/// do not count, because clinical contours cut holes out of a region by an edge that goes in and out along the same
/// path ("keyhole"). Algorithm: sweep over the edges sorted along the longer axis of the polygon; O(n log n + number of
/// pairs whose intervals overlap).
/// @param points [mm] (n) vertices of the polygon, the first one not repeated
/// @param tolerance [mm] edges that overlap by less than this only touch, because coordinates are rounded in files
std::optional<Crossing> find_self_crossing(const std::vector<Eigen::Vector2d>& points, double tolerance);

}  // namespace stylet::detail

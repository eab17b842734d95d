// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shape.hpp"

namespace stylet::meshing {

/// The connected pieces of the solid {distance < 0}, with neighbours along the grid lines.
struct Islands {
  std::vector<int> piece;      ///< (grid nodes) number of the piece, -1 outside
  std::vector<double> volume;  ///< [mm³] (pieces)
};

Islands find_islands(const GridShape& grid);

/// Removes the pieces for which `keep` is false and makes the values true distances again.
/// @return volume left / volume before
double keep_islands(GridShape& grid, const Islands& islands, const std::vector<bool>& keep);

/// A piece smaller than this fraction of the largest piece counts as an island.
inline constexpr double kSmallIsland = 0.01;

/// Removes pieces smaller than `fraction` of the largest piece, such as stray voxels and slips of the pen.
/// @return volume removed [mm³]
double drop_small_islands(GridShape& grid, double fraction);

}  // namespace stylet::meshing

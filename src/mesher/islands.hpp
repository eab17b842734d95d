// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shape.hpp"

namespace stylet::meshing {

/// Pieces of the solid {distance < 0} that hang together along the grid.
struct Islands {
  std::vector<int> piece;      ///< (grid nodes) number of the piece, -1 outside
  std::vector<double> volume;  ///< [mm³] (pieces)
};

Islands find_islands(const GridShape& grid);

/// Removes the pieces for which `keep` is false; distances are made true again.
/// @return volume left, as a fraction of the volume before
double keep_islands(GridShape& grid, const Islands& islands, const std::vector<bool>& keep);

/// What is an island beside the largest piece, as a fraction of its volume.
inline constexpr double kSmallIsland = 0.01;

/// Removes pieces smaller than `fraction` of the largest: stray voxels and slips of the pen.
/// @return volume removed [mm³]
double drop_small_islands(GridShape& grid, double fraction);

}  // namespace stylet::meshing

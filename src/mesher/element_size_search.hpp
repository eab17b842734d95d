// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "tetrahedraliser.hpp"

namespace stylet::meshing {

/// A refined mesh with the wanted number of nodes.
struct SizedMesh {
  std::unique_ptr<Tetrahedraliser> tetrahedra;
  double scale = 0;  ///< [mm] edge length in the target with which it was made
};

/// Finds the scale of the size field with which refinement gives `wanted` nodes within 3 % (usually within 1.5 %). The
/// number of nodes is a noisy, stepwise function of the scale. The search takes secant steps in logarithms until the
/// solution is enclosed, then narrows the interval; where a step of the function is in the way, it tries scales around
/// it.
/// @param input_for returns the input of the mesh generator for a scale [mm]
/// @param guess first scale [mm]
/// @return an error when fewer nodes are wanted than the anatomy needs, with the number that it needs
Result<SizedMesh> find_element_size(const std::function<TetrahedraliserInput(double scale)>& input_for, Index wanted,
                                    double guess, const Progress& progress);

}  // namespace stylet::meshing

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "tetrahedraliser.hpp"

namespace stylet::meshing {

/// A refined mesh with the wanted number of nodes.
struct SizedMesh {
  std::unique_ptr<Tetrahedraliser> tetrahedra;
  double scale = 0;  ///< [mm] edge length in the target that gave it
};

/// Finds the scale of the size field at which refinement gives `wanted` nodes within 3 % (most often within 1.5 %). The
/// count is a noisy, stepwise function of the scale: secant steps in logarithms until it is enclosed, then trials that
/// close in and, where a step is in the way, spread around it.
/// @param input_for what to mesh at a scale [mm]
/// @param guess first scale [mm]
/// Errors: fewer nodes wanted than the anatomy needs, naming about how many it does need.
Result<SizedMesh> find_element_size(const std::function<TetrahedraliserInput(double scale)>& input_for, Index wanted,
                                    double guess, const Progress& progress);

}  // namespace stylet::meshing

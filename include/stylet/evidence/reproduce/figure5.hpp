// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <vector>

namespace stylet::reproduce {

/// Median processor times [s] of `repeats` updates of K⁻¹ when a node is added, for one size of the tissue.
struct Figure5Row {
  int dim = 0;                        ///< degrees of freedom after the change, the order of K
  int change = 0;                     ///< order of ΔK
  double inverse_s = 0.0;             ///< inversion of the new K from scratch
  double bcs_s = 0.0;                 ///< boundary condition switches
  double woodbury_s = 0.0;            ///< matrix inversion lemma on the whole matrix, as the paper writes it
  double woodbury_symmetric_s = 0.0;  ///< matrix inversion lemma on one triangle only
  double largest_error = 0.0;  ///< largest difference of a method from the inverse, relative to its largest entry
  int repeats = 0;
  int added = 0;                          ///< degrees of freedom of the new node, part of those of ΔK
  double bcs_multiplications = 0.0;       ///< counted multiplications and divisions of the switches
  double woodbury_multiplications = 0.0;  ///< counted multiplications and divisions of the lemma on the whole matrix
};

/// The paper's figure 5: time to update K⁻¹ against the order of K. The tissue is a square in plane strain with one
/// side held. A node is added on an edge, so that two triangles become four (ΔK is 10 × 10). Four methods are timed in
/// turn, with one BLAS thread: inversion of the new K from scratch, boundary condition switches, and the matrix
/// inversion lemma on the whole matrix and on one triangle.
/// @param dims wanted orders of K, 30 … 5,000; the nearest order that the square can have is used
/// @param seconds_per_size [s] processor time for each size; there are at least three repeats
/// Errors: failed, when a method differs from the inverse from scratch by more than 1e-8.
Result<std::vector<Figure5Row>> measure_figure5(const std::vector<int>& dims, double seconds_per_size,
                                                const Progress& progress = {});

/// The orders of K in the paper's figure, 50 … 2,000; with `quick` fewer and up to 800.
std::vector<int> figure5_dims(bool quick);

}  // namespace stylet::reproduce

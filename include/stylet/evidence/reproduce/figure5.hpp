// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <vector>

namespace stylet::reproduce {

/// One size of the tissue: processor time to change K⁻¹ when a node is added, medians over `repeats` runs [s].
struct Figure5Row {
  int dim = 0;     ///< degrees of freedom after the change, the order of K
  int change = 0;  ///< order of ΔK
  double inverse_s = 0.0;
  double bcs_s = 0.0;
  double woodbury_s = 0.0;            ///< the whole matrix, as the paper writes it
  double woodbury_symmetric_s = 0.0;  ///< one triangle only
  double largest_error = 0.0;         ///< of any method against the inverse from scratch, over its largest entry
  int repeats = 0;
  int added = 0;                          ///< degrees of freedom of the new node, among those of ΔK
  double bcs_multiplications = 0.0;       ///< and divisions, counted
  double woodbury_multiplications = 0.0;  ///< likewise, on the whole matrix
};

/// The paper's figure 5: time to bring K⁻¹ up to date against the order of K. A square of tissue in plane strain, one
/// side held; a node is added on an edge, two triangles become four (ΔK 10 × 10). Four ways: inverting the new K from
/// scratch, boundary condition switches, the matrix inversion lemma on the whole matrix and on one triangle. BLAS with
/// one thread; the methods take turns.
/// @param dims wanted orders of K, each met as nearly as a square allows, 30 … 5,000
/// @param seconds_per_size processor time spent on each size, at least three repeats
/// Errors: failed, when a method differs from the inverse from scratch by more than 1e-8: nothing is timed that is
/// wrong.
Result<std::vector<Figure5Row>> measure_figure5(const std::vector<int>& dims, double seconds_per_size,
                                                const Progress& progress = {});

/// The paper's range, 50 … 2,000.
std::vector<int> figure5_dims(bool quick);

}  // namespace stylet::reproduce

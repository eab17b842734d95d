// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/types.hpp"

namespace stylet::detail {

/// (L Lᵀ)⁻¹ from a dense Cholesky factor, computed in panels by several threads. One thread computes each panel with
/// single-threaded BLAS, so the result does not depend on the number of threads. It is symmetric to the last bit.
/// @param L lower triangular with zeros in the upper triangle (n × n); the result reuses its memory
MatX inverse_from_factor(MatX L, const Progress& progress = {});

}  // namespace stylet::detail

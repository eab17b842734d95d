// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/types.hpp"

namespace stylet::detail {

/// (L Lᵀ)⁻¹ from a dense Cholesky factor, in panels on several threads. Each panel is one thread's and BLAS has one
/// thread, so the result does not depend on the number of threads; symmetric to the last bit.
/// @param L lower triangular, the other triangle zero (n × n); its memory becomes the result's
MatX inverse_from_factor(MatX L, const Progress& progress = {});

}  // namespace stylet::detail

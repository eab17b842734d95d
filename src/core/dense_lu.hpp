// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

/// Dense LU with partial pivoting in place; nothing here allocates.
namespace stylet::dense {

/// Solves A x = b, A and b are overwritten (A by its factors, b by x).
/// @return false when A is singular to working precision
[[nodiscard]] bool solve_unsymmetric(Eigen::Ref<MatX> A, Eigen::Ref<VecX> b);

}  // namespace stylet::dense

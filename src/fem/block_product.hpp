// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "assembly.hpp"

namespace stylet::detail {

/// Several loads side by side, or the displacements by them: one row for each free degree of freedom, so that one pass
/// over the stiffness serves all of them.
inline constexpr int kSideBySide = 16;
using Loads = Eigen::Matrix<double, Eigen::Dynamic, kSideBySide, Eigen::RowMajor>;

/// Y ← K X
/// @param Y (free × kSideBySide) output, of the size of X
void multiply(const Assembled& assembled, const Loads& X, Loads& Y);

}  // namespace stylet::detail

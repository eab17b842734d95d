// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::cli {

/// Bounds the helper threads of the numerical libraries (OpenBLAS, OpenMP) of this process.
/// @param most [threads] ≥ 1
void limit_threads(int most);

}  // namespace stylet::cli

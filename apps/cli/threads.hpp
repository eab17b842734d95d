// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::cli {

/// Limits the number of threads of the numerical libraries (OpenBLAS, OpenMP) in this process.
/// @param most largest number of threads, ≥ 1
void limit_threads(int most);

}  // namespace stylet::cli

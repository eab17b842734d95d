// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// The one-to-one assignment of rows to columns with the least sum of costs, by shortest augmenting paths: R. Jonker
/// and A. Volgenant, Computing 38 (1987) 325, for rectangular matrices as in D. F. Crouse, IEEE Trans. Aerosp.
/// Electron. Syst. 52 (2016) 1679. The time grows as rows² × columns.
/// @param cost (rows × columns) finite numbers, with rows ≤ columns
/// @return (rows) the column of each row
std::vector<Index> cheapest_assignment(const MatX& cost);

}  // namespace stylet

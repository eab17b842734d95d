// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <string>
#include <vector>

namespace stylet::detail {

/// Lengths of what is loaded into a needle [mm].
struct TrainLengths {
  double seed_mm = 4.5;
  double spacer_mm = 5.5;
};

/// Distances [mm] of the seeds' centres from the superior end of a train. The train is written from the needle's tip
/// on, its elements separated by '-': S is a seed, a whole number that many spacers. "S-1-S" has its seeds 10 mm apart.
/// Errors: an element that is neither, with its position; no seed.
/// @param where file and needle, for messages
Result<std::vector<double>> seeds_of_train(const std::string& train, const TrainLengths& lengths,
                                           const std::string& where);

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/seed_history.hpp"
#include "stylet/sim/scenario.hpp"

#include <vector>

namespace stylet {

/// Settles the seeds of one needle after they were dropped: a strand keeps its spacing along its own line,
/// which may be bent; each seed, or the whole strand, may jump along its track and may be lost.
/// @param seeds of one needle, from its tip on
/// @param needle number of the needle, which with SeedChoice::random starts the random numbers
void settle_seeds(std::vector<SeedHistory>& seeds, const Scenario::Seed& choice, std::size_t needle);
/// A settled seed as it was dropped: the inverse of settle_seeds(), to the last bits of its place.
SeedHistory as_dropped(SeedHistory settled);

}  // namespace stylet

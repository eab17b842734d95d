// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"
#include "stylet/implant/needle_load.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet {

/// The insertion that brings a loaded needle to its depth: the skin point on its line, its direction, and the depth of
/// its tip from there.
/// @param scenario its needle limits the depth @param locator of the patient's mesh
/// @param where name of the scenario in messages
/// Errors: the line misses the patient; the needle is too short; the train does not fit between the skin and the tip.
Result<InsertionPlan> needle_insertion(const NeedleLoad& load, const Scenario& scenario, const Locator& locator,
                                       const std::string& where);

/// The depth of the base from the skin at which a seed is pushed out of the tip of a straight needle at its planned
/// place: the tip is at the seed's near end.
/// @param depth_mm depth of the needle (needle_insertion()) @param seed_length_mm length of a seed's capsule
[[nodiscard]] double drop_depth_mm(double depth_mm, const LoadedSeed& seed, double seed_length_mm);

}  // namespace stylet

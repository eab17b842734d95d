// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/probe/probe_place.hpp"
#include "stylet/sim/scenario.hpp"

#include <string>
#include <string_view>

namespace stylet::serve {

/// Whether a key of [probe] is a motion of its stepper.
bool is_of_stepper(std::string_view key);

/// Moves the probe to a tracked pose by the motions of a stepper. Small deviations that a stepper lacks are left out; a
/// pose that a stepper does not reach leaves the probe where it is.
/// @param pose LPS, see stepper_motions()
/// @param tables its keys of [probe] are changed
/// @return what the pose has beyond the stepper's motions, or why the probe does not follow, in words; empty: the probe
/// is at the pose
std::string follow(const Pose& pose, const ProbeSeat& seat, Scenario& tables);

}  // namespace stylet::serve

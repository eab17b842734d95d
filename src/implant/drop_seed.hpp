// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/material_search.hpp"
#include "stylet/sim/simulation.hpp"

#include <functional>
#include <optional>

namespace stylet {

/// The displacement of the material point at x [mm] LPS; empty where it is not known.
using DisplacementAt = std::function<std::optional<Insertion::PointDisplacement>(const Vec3& x)>;

/// The material point that the displacement brings to a place in the room (MaterialSearch).
/// @return empty where the displacement is not known, or where no point comes nearer than 0.2 mm
std::optional<FoundMaterial> material_at(const Vec3& place, const DisplacementAt& displacement);

/// The displacement in a simulation after its last step, with the needle's near field.
DisplacementAt displacement_in(Simulation& simulation);

}  // namespace stylet

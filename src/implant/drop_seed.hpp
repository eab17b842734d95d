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

/// The tissue at a place in the room.
struct TissueAt {
  bool is_known = false;           ///< otherwise the place itself counts as that of the tissue
  Vec3 rest_mm = Vec3::Zero();     ///< [mm] LPS, the tissue's place at rest
  Vec3 lasting_mm = Vec3::Zero();  ///< [mm] LPS, the part of its displacement to which it has crept
  Vec3 axis = Vec3::UnitZ();       ///< unit vector LPS, of a capsule in the tissue at rest
};

/// The tissue in which a capsule lies: at its centre, and at its ends for its axis.
/// @param centre [mm] LPS @param axis unit vector LPS @param length_mm of the capsule
TissueAt tissue_of_capsule(const Vec3& centre, const Vec3& axis, double length_mm, const DisplacementAt& displacement);

/// The displacement in a simulation after its last step, with the needle's near field.
DisplacementAt displacement_in(Simulation& simulation);

}  // namespace stylet

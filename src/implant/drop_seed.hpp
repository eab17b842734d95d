// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

#include <functional>
#include <optional>

namespace stylet {

/// A point of the tissue that is at a given place in the room.
struct FoundMaterial {
  Vec3 x = Vec3::Zero();                 ///< [mm] LPS, its place in the tissue at rest
  Insertion::PointDisplacement moved{};  ///< its displacement, x + moved.whole is the place in the room
};

/// The displacement of the material point at x [mm] LPS; empty where it is not known.
using DisplacementAt = std::function<std::optional<Insertion::PointDisplacement>(const Vec3& x)>;

/// Finds the material point that the displacement brings to a place in the room: X with X + u(X) = place. The iteration
/// X ← place − u(X) converges as long as the tissue is not strained by more than its own length.
/// Where the displacement jumps, so that no point is there, it is the point that comes nearest.
/// @return empty where the displacement is not known, or where no point comes nearer than 0.2 mm
std::optional<FoundMaterial> material_at(const Vec3& place, const DisplacementAt& displacement);

/// The displacement in a simulation after its last step, with the needle's near field.
DisplacementAt displacement_in(Simulation& simulation);

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/probe/probe_place.hpp"

namespace stylet {

/// Distance [mm] along the axis from the transverse array to the centre of the hemisphere at a probe's end. Stated: the
/// transverse array of a biplane probe lies where its cylinder ends.
inline constexpr double kRoundBeyondArray_mm = 2.0;

/// The surface of a rigid probe: a half-infinite cylinder with a hemisphere at its end. The shaft has no other end,
/// because it goes on out of the patient.
struct Capsule {
  Vec3 centre_mm = Vec3::Zero();  ///< LPS, of the hemisphere
  Vec3 axis = Vec3::UnitZ();      ///< unit vector from the shaft towards the rounded end
  double radius_mm = 10.0;

  /// How a point of the wall lies to the surface.
  struct Gap {
    double mm = 0.0;              ///< negative: the point has to move by this much along `normal`
    Vec3 normal = Vec3::UnitZ();  ///< unit vector out of the probe
  };

  /// The gap of a point that stays on its own side of the probe.
  ///
  /// The signed distance of a point p from a convex body is the largest value of n · p − h(n) over all unit vectors n,
  /// where h is the body's support function. Here n is restricted to directions within kSide of `outward`, the wall's
  /// own direction, and to directions that do not point back along the shaft, where h is infinite. The result is the
  /// signed distance where the nearest point of the surface is on the wall's side, and smaller elsewhere. It is
  /// continuous in p, and a force along `normal` never pulls the wall to the other side of the probe.
  /// @param p [mm] LPS
  /// @param outward unit vector from the lumen into the wall; not opposite to `axis`
  [[nodiscard]] Gap gap(const Vec3& p, const Vec3& outward) const;

  /// The gap to the nearest point of the surface, whatever the wall's side.
  [[nodiscard]] Gap nearest(const Vec3& p) const;

  /// Cosine of the largest angle between a wall's own direction and the force on it: 45°.
  static constexpr double kCosSide = 0.70710678118654752;
};

/// The surface of the probe at a place.
Capsule capsule_of(const ProbePlace& place);

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <algorithm>
#include <cmath>

/// A bevelled tip, by one of two laws.
///
/// offset: the tip's wedge cuts under ψ to the axis, h = d tan ψ beside it after a cut of length d. The point that cuts
/// is part of the needle, so the cut cannot leave the shaft: the way back to the axis (cutting.cpp) holds it at
/// g = 2R tan ψ. Shaft contacts come to lie on that line, tissue draws the shaft towards it, and the needle bends.
///
/// force: the tissue pushes the tip towards its sharp side by a share of the tip's axial force; on the tissue acts the
/// opposite. Where shaft contacts have taken over the tip's lateral hold, its lateral rows stay in the system as soft
/// as rows may be, and carry this force.
namespace stylet {

namespace {
/// A lateral row this much softer than the tissue carries its given force and nothing else.
constexpr double kNotHeld = 1e6;
}  // namespace

Vec3 Bevel::sharp_side(const Pose& base, const Vec3& tangent) {
  const Vec3 axis = base.rotation * Vec3::UnitZ();
  return Eigen::Quaterniond::FromTwoVectors(axis, tangent) * (base.rotation * Vec3::UnitX());
}

/// What a bevel of law `offset` adds to the direction of the cut, so that the cut leaves the axis at ψ and goes over to
/// the line g beside it.
Vec3 Insertion::Parts::lead_of_bevel(const Vec3& tangent) const {
  const double slope = settings.bevel.slope();
  if (slope == 0.0) return Vec3::Zero();
  const Vec3 side = Bevel::sharp_side(base, tangent);
  if (!std::isfinite(tip.lateral_softness)) return slope * side;  // the way back does the rest
  // While the tip itself is held sideways the end of its track cannot leave it. How far it would be away were it let go
  // is told by the force that holds it.
  const double own = compliance(ContactCompliance::kTip, ContactCompliance::kTip).trace() / 3.0;
  const double beside = -(tip.lateral_softness + own) * tip.force.dot(side);
  return std::clamp(slope - beside / settings.merge_mm, 0.0, slope) * side;
}

/// [mm/N] of the tip's lateral rows.
double Insertion::Parts::tip_lateral_softness() const {
  if (std::isfinite(tip.lateral_softness)) return tip.lateral_softness;
  if (!settings.bevel.pushes()) return 0.0;
  return kNotHeld * compliance(ContactCompliance::kTip, ContactCompliance::kTip).trace() / 3.0;
}

/// Whether the tip's lateral rows are part of the system.
bool Insertion::Parts::tip_lateral_rows() const {
  return std::isfinite(tip.lateral_softness) || settings.bevel.pushes();
}

/// [N] on the tissue, from a bevel of law `force`.
Vec3 Insertion::Parts::bevel_force() const {
  if (!settings.bevel.pushes()) return Vec3::Zero();
  const Vec3 t = needle->tangent(length());
  return -settings.bevel.force_ratio * std::max(0.0, tip.force.dot(t)) * Bevel::sharp_side(base, t);
}

}  // namespace stylet

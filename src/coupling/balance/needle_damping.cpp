// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/needle_damping.hpp"

#include <algorithm>

namespace stylet {

namespace {
/// Damping over the time since the tip struck bone. Raised, the needle follows a strike later; lowered, a snap soon
/// after a strike is damped less.
constexpr double kDampedShare = 0.1;
}  // namespace

double NeedleDamping::in_step(double h, bool on_bone, bool in_parts) const {
  if (in_parts) return most_s_;
  return on_bone ? std::min(most_s_, kDampedShare * (on_bone_for_s_ + h)) : 0.0;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/needle_damping.hpp"

#include <algorithm>

namespace stylet {

namespace {
/// Damping over the time since the tip struck bone. Raised, the needle follows a strike later; lowered, a snap soon
/// after a strike is damped less.
constexpr double kDampedShare = 0.1;
/// Factor on the damping after a balance that was not found. Raised, fewer sub-steps are flagged, and the needle moves
/// less in them.
constexpr double kMoreDamping = 4.0;
/// Factor on the damping after a balance that was found. Raised, the needle is slowed down for longer.
constexpr double kWearsOff = 0.8;
/// The damping is set to zero below this part of the damping on bone. Raised, it ends sooner.
constexpr double kNoDamping = 0.05;
/// Largest damping, over the damping on bone. Raised, a needle without a balance stands still for longer.
constexpr double kMostDamping = 1e3;
}  // namespace

double NeedleDamping::begin(double h, bool on_bone) {
  on_bone_for_s_ = on_bone ? on_bone_for_s_ + h : 0.0;
  rescue_s_ = balanced_ ? kWearsOff * rescue_s_ : std::max(kMoreDamping * rescue_s_, most_s_);
  if (rescue_s_ < kNoDamping * most_s_) rescue_s_ = 0.0;
  rescue_s_ = std::min(rescue_s_, kMostDamping * most_s_);
  return std::max(rescue_s_, std::min(most_s_, kDampedShare * on_bone_for_s_));
}

void NeedleDamping::forget() {
  balanced_ = true;
  rescue_s_ = on_bone_for_s_ = 0.0;
}

}  // namespace stylet

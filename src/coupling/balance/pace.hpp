// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet {

/// How a quantity is expected to change in a sub-step, given its changes in the two sub-steps before: by
/// share × (last change) + trend × (the part of the last change that was not in proportion to the one before).
struct Pace {
  double share = 0.0;  ///< 0 = nothing is known: no change is expected
  double trend = 0.0;
};

/// How the force of a contact on the tissue has changed in the last sub-steps. All in newtons, LPS.
struct ForceHistory {
  Vec3 start = Vec3::Zero();   ///< the force at the start of the sub-step
  Vec3 gained = Vec3::Zero();  ///< its change in the last sub-step
  Vec3 more = Vec3::Zero();    ///< the part of that change that was not in proportion to the change before

  [[nodiscard]] Vec3 expected(const Pace& pace) const { return pace.share * gained + pace.trend * more; }
};

}  // namespace stylet

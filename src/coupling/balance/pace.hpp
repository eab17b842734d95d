// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet {

/// Predictor of a quantity q in a sub-step: q ← q + share·Δq + trend·Δ²q, where Δq is the change in the last sub-step
/// and Δ²q is the part of Δq that was not in proportion to the change before it.
struct Pace {
  double share = 0.0;  ///< 0: no change is predicted
  double trend = 0.0;
};

/// The change of a contact's force on the tissue in the last sub-steps. In newtons, LPS.
struct ForceHistory {
  Vec3 start = Vec3::Zero();   ///< the force at the start of the sub-step
  Vec3 gained = Vec3::Zero();  ///< its change in the last sub-step
  Vec3 more = Vec3::Zero();    ///< the part of that change that was not in proportion to the previous change

  [[nodiscard]] Vec3 expected(const Pace& pace) const { return pace.share * gained + pace.trend * more; }
};

}  // namespace stylet

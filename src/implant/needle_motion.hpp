// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/needle_load.hpp"
#include "stylet/sim/model.hpp"

namespace stylet {

/// The moment at which a seed is left.
struct SeedDrop {
  /// [s] With technique `preloaded`: when the cannula begins to be drawn back over the train. With `pushed`: when the
  /// seed has been pushed out of the tip.
  double time_s = 0.0;
};

/// The motion of a needle's base through a procedure, and when its seeds are left.
struct NeedleMotion {
  PlannedInsertion insertion;
  std::vector<SeedDrop> drops;  ///< one for each seed of the load; none of a catheter
  double in_s = 0.0;            ///< [s] when the needle has reached its full depth
};

/// Plans the motion of one needle: in, a pause, out slowly while the seeds are dropped, out. It ends 3 mm in front of
/// the skin. A needle without seeds, or a catheter, goes in and stays.
/// @param entry [mm] LPS skin point on the needle's line
NeedleMotion plan_needle_motion(const NeedleLoad& load, const Vec3& entry, const Scenario& scenario,
                                double seed_length_mm);

}  // namespace stylet

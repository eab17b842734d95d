// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/gland_motion.hpp"

namespace stylet {

std::vector<NamedShift> named_shifts(const GlandMotion& motion) {
  std::vector<NamedShift> shifts{{"just before its surface broke", motion.shift_at_break_mm},
                                 {"largest", motion.shift_max_mm},
                                 {"needle in place", motion.shift_in_place_mm},
                                 {"1 s after withdrawal", motion.shift_residual_mm},
                                 {"base (superior third)", motion.base_mm},
                                 {"mid (middle third)", motion.mid_mm},
                                 {"apex (inferior third)", motion.apex_mm}};
  for (NamedShift& shift : shifts) {
    if (shift.mm && !shift.mm->allFinite()) shift.mm.reset();
  }
  return shifts;
}

std::vector<NamedTurn> named_turns(const GlandMotion& motion) {
  const PlaneAngles angles = plane_angles(motion.rotation_deg);
  const auto turn = [](const char* plane, double degrees, const char* positive, const char* negative) {
    return NamedTurn{plane, degrees, degrees < 0.0 ? negative : positive};
  };
  return {turn("coronal", angles.coronal, "base to the left", "base to the right"),
          turn("sagittal", angles.sagittal, "base to anterior", "base to posterior"),
          turn("transverse", angles.transverse, "left side to posterior", "left side to anterior")};
}

}  // namespace stylet

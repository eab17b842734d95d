// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/step.hpp"

#include <string>
#include <vector>

namespace stylet {

/// NeedleShape::when of the shape that a needle has once all needles of its group are in the tissue; a needle that is
/// alone in the tissue has no such shape.
inline constexpr const char* kAllInPlace = "all in place";

/// The centreline of a needle at one moment.
struct NeedleShape {
  std::string when;     ///< "full depth", kAllInPlace, or "seed 3 dropped" with the seed's number in the plan, from 1
  double time_s = 0.0;  ///< [s] as Step::time_s
  double base_depth_mm = 0.0;   ///< [mm] of its base, as Step::base_depth_mm
  std::vector<Vec3> points_mm;  ///< (kNeedleShapePoints) [mm] LPS, evenly spaced from base to tip
};
inline constexpr int kNeedleShapePoints = 41;

/// The motion, forces and shapes of one needle of an implant. All times are simulated times since the first needle of
/// its group went in: needles of a group are in the tissue together, and stabilising needles belong to each group.
struct NeedleRecord {
  std::size_t group = 0;            ///< number of its group, in the order in which the groups were simulated
  std::vector<Step> steps;          ///< all of them; step_us is the processor time
  std::vector<NeedleShape> shapes;  ///< in order of time
};

}  // namespace stylet

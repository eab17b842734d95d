// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/measure/demo.hpp"
#include "stylet/sim/scenario.hpp"

#include <vector>

namespace stylet::validate {

inline constexpr double kSeedLength_mm = 4.5;
inline constexpr double kImplantSpeed_mm_per_s = 40.0;

/// The demo's scenario for an implant, without needles: faster and in larger steps than a single insertion.
inline Scenario implant_scenario() {
  Scenario scenario = measure::demo_scenario();
  scenario.insertions.clear();
  scenario.run.dt_ms = 4.0;
  scenario.output.frames_per_s = 0.0;
  scenario.procedure.speed_mm_per_s = kImplantSpeed_mm_per_s;
  scenario.procedure.retract_speed_mm_per_s = kImplantSpeed_mm_per_s;
  scenario.procedure.drop_speed_mm_per_s = 10.0;
  return scenario;
}

/// Numbers of the regions that form the demo's gland.
inline std::vector<int> gland_of(const TetMesh& mesh) {
  std::vector<int> gland;
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    if (mesh.regions[r] == "prostate") gland.push_back(static_cast<int>(r));
  }
  return gland;
}

}  // namespace stylet::validate

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sim/box_patient.hpp"

namespace stylet::test {

/// The scenario of the saved box. Its mesh is given separately; "phantom" is the only source that is not a path.
inline Scenario saved_box() {
  Scenario scenario = box_scenario();
  scenario.patient.source = "phantom";
  return scenario;
}

}  // namespace stylet::test

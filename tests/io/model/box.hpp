// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sim/box_patient.hpp"

namespace stylet::test {

/// The box as it is saved; its mesh is given, and "phantom" is the one source that is not a path.
inline Scenario saved_box() {
  Scenario scenario = box_scenario();
  scenario.patient.source = "phantom";
  return scenario;
}

}  // namespace stylet::test

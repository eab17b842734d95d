// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/scenario.hpp"

namespace stylet {

/// What stands for the wildcards of a path: "tissue.<region>.…", "patient.regions.<name>", "insertion[].…".
struct ScenarioSlot {
  std::string name;
  std::size_t index = 0;
};

/// A key and where its value lives.
struct ScenarioEntry {
  ScenarioKey key;
  /// Stores a value of the key's type, making the slot where it is new; a text says why the value is refused.
  std::function<std::string(Scenario&, const ScenarioSlot&, const ScenarioValue&)> store;
  /// Loads from a slot that exists; empty when the key is not set.
  std::function<std::optional<ScenarioValue>(const Scenario&, const ScenarioSlot&)> load;
};

/// All keys of the scenario: path, unit, default, range, meaning, and the field each one stands for.
const std::vector<ScenarioEntry>& scenario_table();

}  // namespace stylet

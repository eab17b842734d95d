// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/scenario.hpp"

namespace stylet {

/// Values of the wildcards of a path: the name in "tissue.<region>.…" and "patient.regions.<name>", the index in
/// "insertion[].…".
struct ScenarioSlot {
  std::string name;
  std::size_t index = 0;
};

/// A key of the scenario, with functions that write and read its field.
struct ScenarioEntry {
  ScenarioKey key;
  /// Stores a value of the key's type; creates the slot if it is new. Returns an empty text, or why it refuses the
  /// value.
  std::function<std::string(Scenario&, const ScenarioSlot&, const ScenarioValue&)> store;
  /// Reads the value from an existing slot; empty if the key is not set.
  std::function<std::optional<ScenarioValue>(const Scenario&, const ScenarioSlot&)> load;
};

/// All keys of the scenario in the order of the documentation.
const std::vector<ScenarioEntry>& scenario_table();

}  // namespace stylet

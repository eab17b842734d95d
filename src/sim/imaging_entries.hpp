// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scenario_entries.hpp"

namespace stylet {

/// Adds the keys of [probe], [ultrasound] and [fluoroscopy].
void describe_imaging(ScenarioEntries& keys);

}  // namespace stylet

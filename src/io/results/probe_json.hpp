// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/probe/patient_probe.hpp"

#include <nlohmann/json_fwd.hpp>

namespace stylet::results {

/// The probe of summary.json. Keys and units: docs/results.
nlohmann::ordered_json probe_json(const ProbeReport& report);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "stylet/sim/recording.hpp"

#include <string>
#include <string_view>

namespace stylet::results {

/// The text of summary.json. Keys and units: docs/results. A value that is not finite becomes null.
/// @param probe the ultrasound probe, for the file beside the report; null if there is none
std::string summary_json(const Summary& summary, const ProbeReport* probe = nullptr);

/// Reads the text that summary_json() wrote.
/// @param where name of the text in messages
Result<Summary> parse_summary_json(std::string_view text, const std::string& where);

}  // namespace stylet::results

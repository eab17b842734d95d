// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/sim/recording.hpp"

#include <string>
#include <string_view>

namespace stylet::results {

/// The text of summary.json. Keys and units: docs/results.md. A value that is not finite becomes null.
std::string summary_json(const Summary& summary);

/// Reads the text that summary_json() wrote.
/// @param where name of the text in messages
Result<Summary> parse_summary_json(std::string_view text, const std::string& where);

}  // namespace stylet::results

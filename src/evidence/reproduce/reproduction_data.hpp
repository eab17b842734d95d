// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/reproduce/reproduction.hpp"

#include <nlohmann/json.hpp>

namespace stylet::reproduce {

using Json = nlohmann::ordered_json;

Json figure2_json(const Figure2& figure);
Json reproduction_data(const Reproduction& reproduction);

/// The curves of one variant as the page wants them: base64 of little-endian floats.
Json curves_json(const Figure6Run& run);

/// "figure6_default.csv"
std::string curve_file(const Figure6Run& run);

/// "punctures the prostate": an event for people.
std::string event_label(const Event& event);

}  // namespace stylet::reproduce

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/reproduce/reproduction.hpp"

#include <nlohmann/json.hpp>

namespace stylet::reproduce {

using Json = nlohmann::ordered_json;

Json figure2_json(const Figure2& figure);
Json reproduction_data(const Reproduction& reproduction);

/// The curves of one variant for the page's script: little-endian floats in base64.
Json curves_json(const Figure6Run& run);

/// Name of the file with a variant's curves, such as "figure6_default.csv".
std::string curve_file(const Figure6Run& run);

}  // namespace stylet::reproduce

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/validate/validation.hpp"

#include <nlohmann/json.hpp>

namespace stylet::validate {

using Json = nlohmann::ordered_json;

Json validation_data(const Validation& validation);

/// What the page's script draws: plots of all rows by id, thinned to what a small picture shows, and the study.
Json page_data(const Validation& validation);

/// "force_balance.csv"
std::string curve_file(const Row& row);

/// A value and its digits for people, "–" where there is none.
std::string value_text(double value);

/// The same of a bound or a pair of bounds: "≤ 10⁻¹⁰", "0.58 … 1.3".
std::string accepted_text(const Accepted& accepted);

}  // namespace stylet::validate

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/validate/validation.hpp"

#include <nlohmann/json.hpp>

namespace stylet::validate {

using Json = nlohmann::ordered_json;

Json validation_data(const Validation& validation);

/// The data that the page's script draws: plots of all rows by id, thinned for small pictures, and the study.
Json page_data(const Validation& validation);

/// Name of the file with a row's curves, such as "force_balance.csv".
std::string curve_file(const Row& row);

/// A value as text for the page; "–" for NaN.
std::string value_text(double value);

/// Accepted values as text for the page: "≤ 10⁻¹⁰", "0.58 … 1.3".
std::string accepted_text(const Accepted& accepted);

}  // namespace stylet::validate

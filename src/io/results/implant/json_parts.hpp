// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "record/json.hpp"
#include "stylet/implant/seed_errors.hpp"

#include <nlohmann/json.hpp>

/// Parts of summary.json of `stylet implant` that stand in several places of it.
namespace stylet::results {

using OrderedJson = nlohmann::ordered_json;
using record::list_of;

/// Number of seeds, distances, and signed errors along the axes.
OrderedJson errors_json(const SeedErrors& errors);

}  // namespace stylet::results

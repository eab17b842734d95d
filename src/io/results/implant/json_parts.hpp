// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "record/json.hpp"
#include "stylet/implant/seed_errors.hpp"

/// Parts of summary.json of `stylet implant` that stand in several places of it.
namespace stylet::results {

using record::Json;
using record::list_of;

/// Number of seeds, distances, and signed errors along the axes.
Json errors_json(const SeedErrors& errors);

}  // namespace stylet::results

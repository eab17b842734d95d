// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "implant/json_parts.hpp"
#include "stylet/io/implant_results.hpp"

namespace stylet::results {

/// `implant.found` of summary.json (docs/results). @param history the simulated implant
Json found_json(const ImplantHistory& history, const FoundImplant& found);

/// Correlation and explained variance of simulated and found errors; null where there are none.
Json agreement_json(const Agreement& agreement);

}  // namespace stylet::results

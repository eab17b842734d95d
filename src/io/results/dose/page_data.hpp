// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/dvh_table.hpp"
#include "stylet/dose/dose_evaluation.hpp"

#include <string>
#include <vector>

namespace stylet::results {

/// The data for the scripts of the page (web/report/src/dose/data.ts), as JSON. The size is bounded,
/// so that the page keeps below 8 MB: masks, surfaces and the dose are thinned where necessary.
/// @param colours (structures) structure_colours()
std::string dose_page_data(const DoseEvaluation& evaluation, const DvhTable& dvh,
                           const std::vector<std::string>& colours);

}  // namespace stylet::results

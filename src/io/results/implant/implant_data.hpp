// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/dvh_table.hpp"
#include "stylet/io/implant_results.hpp"

#include <string>

namespace stylet::results {

/// The data for the scripts of the page beside those of the delivered dose (web/report/src/implant/data.ts), as JSON.
/// @param planned histograms of the plan, at the doses of the delivered ones
/// @param found those of the seeds that were found on images; nullptr: none are given
std::string implant_page_data(const ImplantOutcome& outcome, const DvhTable& planned, const DvhTable* found);

}  // namespace stylet::results

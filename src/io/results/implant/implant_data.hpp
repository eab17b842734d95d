// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/dvh_table.hpp"
#include "stylet/implant/seed_errors.hpp"

#include <string>

namespace stylet::results {

/// The data for the scripts of the page beside those of the delivered dose (web/report/src/implant/data.ts), as JSON.
/// @param planned histograms of the plan, at the doses of the delivered ones
std::string implant_page_data(const ImplantHistory& history, const DvhTable& planned);

}  // namespace stylet::results

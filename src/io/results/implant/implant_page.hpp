// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <string>

namespace stylet::results {

/// The page report.html of `stylet implant`, complete with styles, scripts and data.
Result<std::string> implant_page(const ImplantOutcome& outcome);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/dose_evaluation.hpp"

#include <string>

namespace stylet::results {

/// The page report.html of `stylet dose`, complete with styles, scripts and data.
Result<std::string> dose_page(const DoseEvaluation& evaluation);

}  // namespace stylet::results

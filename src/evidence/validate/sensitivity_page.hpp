// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/validate/sensitivity.hpp"

#include <string>

namespace stylet::validate {

/// The study as a section of the page: a table whose cells are bars around the base value (a tornado for each output),
/// the most influential parameter first.
std::string sensitivity_html(const Sensitivity& study);

/// Positions of the influences, the most influential first: by the largest change of any output, each relative to the
/// largest change that any parameter makes of that output.
std::vector<std::size_t> by_influence(const Sensitivity& study);

/// "+12 %", "−0.3 %": change from `from` to `to`, in words.
std::string change_text(double from, double to);

}  // namespace stylet::validate

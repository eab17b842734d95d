// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/validate/sensitivity.hpp"

#include <string>

namespace stylet::validate {

/// The study as an HTML section of the page: a table whose cells are bars around the base value (a tornado plot for
/// each output), the most influential parameter first.
std::string sensitivity_html(const Sensitivity& study);

/// Indices of the influences, the most influential first. The order is by the largest change of any output, relative to
/// the largest change of that output by any parameter. Choices come last.
std::vector<std::size_t> by_influence(const Sensitivity& study);

/// The relative change from `from` to `to` as text: "+12 %", "−0.3 %".
std::string change_text(double from, double to);

}  // namespace stylet::validate

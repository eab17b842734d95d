// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/dvh_table.hpp"

#include <string>
#include <vector>

namespace stylet::results {

/// The histograms as an SVG picture, for readers without a script; empty without a structure.
/// @param colours (structures) structure_colours()
std::string dvh_picture(const DoseEvaluation& evaluation, const DvhTable& dvh, const std::vector<std::string>& colours);

}  // namespace stylet::results

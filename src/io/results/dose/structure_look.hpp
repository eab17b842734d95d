// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet::results {

/// Colours of the structures on a white page, as "#rrggbb": the file's own, made darker where they could hardly be
/// seen; for structures without one, and for structures whose colour another one has already, colours of Okabe and Ito.
std::vector<std::string> structure_colours(const std::vector<StructureDose>& structures);

/// Whether a structure surrounds the others, like the outline of the body, so that it would hide them in 3D.
bool surrounds_others(const StructureDose& structure);

/// The first structure that is taken as this region; nullptr where there is none.
const StructureDose* find_region(const DoseEvaluation& evaluation, const std::string& region);

}  // namespace stylet::results

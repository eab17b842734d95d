// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/dvh_table.hpp"

#include <string>
#include <vector>

namespace stylet::results {

/// The histograms as an SVG picture, for readers without a script; empty without a structure.
/// @param colours (structures) structure_colours() @param planned histograms at the same doses, drawn with dashes;
/// nullptr: none @param found those of the seeds that were found on images, drawn with dots; nullptr: none
std::string dvh_picture(const std::vector<StructureDose>& structures, const DvhTable& dvh,
                        const std::vector<std::string>& colours, const DvhTable* planned = nullptr,
                        const DvhTable* found = nullptr);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <string>

/// The tables of the page of `stylet implant`, as HTML.
namespace stylet::results {

/// The figures that everybody asks for first, as items of a list.
std::string implant_tiles(const ImplantOutcome& outcome);

/// A row of a table of errors: name, number of seeds, distances, and signed errors along the axes.
std::string error_row(const std::string& name, const SeedErrors& errors);

/// The errors of all seeds and of those in each third.
std::string error_table(const ImplantHistory& history);

/// The causes that moved a seed, with their meaning and mean size, as pairs of name and text.
std::string cause_meanings(const ImplantHistory& history);

/// The needles in the order in which they went in.
std::string needle_table(const ImplantHistory& history);

/// All seeds, with the size of each cause that moved one.
std::string seed_error_table(const ImplantHistory& history);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <string>

/// The pictures of the seeds that were found on images, as HTML.
namespace stylet::results {

/// The looks of the lines of found_scatters(), as attributes in SVG: equal errors, and these moved by the common shift.
inline constexpr const char* kEqualLine = "stroke=\"#5b6169\" stroke-width=\"1.8\"";
inline constexpr const char* kShiftedLine = "stroke=\"#c44601\" stroke-width=\"1.8\" stroke-dasharray=\"7 5\"";

/// Three pictures, one for each axis, as figures: the error of each matched seed as it was found, over the simulated
/// error, with the line on which both are equal, and that line moved by the common shift. All have the same scale.
std::string found_scatters(const ImplantHistory& history, const FoundComparison& comparison);

/// The parts of the mean square of the errors found as bars, with the common shift and without it.
std::string found_parts_picture(const FoundComparison& comparison);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <string>

namespace stylet {

/// [mm] Sizes between which the tissue around a needle lies, from a small phantom to a whole body.
inline constexpr double kSmallestPatient_mm = 10.0;
inline constexpr double kLargestPatient_mm = 2000.0;

/// Checks the size of what was read from a file with coordinates: the one rule for a wrong unit of length.
/// @param extent_mm largest side of the bounding box, with the unit that was taken
/// @param where file for the message @param what "the mesh", "the surfaces"
/// @param unit_mm unit with which the coordinates were multiplied, which the message then states; 1: taken as mm
/// @param smallest_mm smallest plausible size; surfaces may be of a small part
/// Errors: a size outside of the limits; the cure names the unit that fits (patient.scale, --scale).
Result<> check_size(double extent_mm, const std::string& where, const std::string& what, double unit_mm = 1.0,
                    double smallest_mm = kSmallestPatient_mm);

}  // namespace stylet

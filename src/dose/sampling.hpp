// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <cmath>
#include <string>

/// Checks and limits that every way of sampling a structure uses.
namespace stylet::dose {

inline constexpr double kMostSamples = 1e8;

/// Checks the distance of samples. @param where the structure, for the message
inline Result<> check_step(double step_mm, const std::string& where) {
  if (std::isfinite(step_mm) && step_mm > 0.0) return Ok{};
  return input_error(where, "the distance of samples is " + std::to_string(step_mm) + " mm, expected a number above 0",
                     "Use 0.5 mm, or less for small structures");
}

/// The error for a structure that would need more than kMostSamples samples.
inline Error too_many_samples(double step_mm, const std::string& where) {
  return input_error(where, "samples every " + std::to_string(step_mm) + " mm would be more than 100 million",
                     "Use a larger distance of samples, and check the unit of the structure");
}

}  // namespace stylet::dose

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <string>

/// Doses and plans as HTML or plain text, as all pages write them.
namespace stylet::results {

/// A dose with one decimal below 100 Gy, with its unit, as HTML.
std::string gray(double dose_Gy);

/// A share with its unit, as HTML.
std::string percent(double value);

/// The share that a dose is of another one, in small letters, as HTML; nothing if there is no other one.
std::string small_share(double dose_Gy, double of_Gy);

/// Implant, number of sources, source model and prescribed dose of a plan in one line.
std::string plan_line(const DoseEvaluation& evaluation);

}  // namespace stylet::results

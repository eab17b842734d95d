// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/implant.hpp"

#include <functional>

namespace stylet {

/// Simulates an implant with needles that are aimed in some way.
using SimulateNeedles = std::function<Result<ImplantHistory>(const std::vector<NeedleLoad>& needles)>;

/// Implants before and after the needles were aimed so that their seeds come to rest where they were planned.
struct Compensation {
  ImplantHistory before;
  ImplantHistory after;
  std::vector<NeedleLoad> needles;  ///< as aimed in `after`
};

/// Aims each needle beside its plan by the mean error of its seeds, with the opposite sign, and repeats this: the line
/// moves sideways and the retraction plane along it. Keeps the aim of the round with the least mean error.
/// @param needles as planned @param rounds how often the aim is corrected, ≥ 1
Result<Compensation> compensate(std::vector<NeedleLoad> needles, int rounds, const SimulateNeedles& simulate);

}  // namespace stylet

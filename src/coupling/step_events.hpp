// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"

#include <limits>

namespace stylet {

/// Adds an event to a step's report, unless the report has no room for one more.
/// @param region number of the region that the event is about, -1 = none
/// @param force_N axial force of the hand when it happened [N]; not a number where that says nothing
inline void add_event(StepReport& report, InsertionEventKind kind, int region,
                      double force_N = std::numeric_limits<double>::quiet_NaN()) {
  if (report.events == static_cast<int>(report.event.size())) return;
  report.event[static_cast<std::size_t>(report.events++)] = {kind, region, force_N};
}

/// Region of an element; −1 for element −1, which stands for the outside of the patient.
inline int region_of(const InsertionTissue& tissue, Index tet) {
  return tet < 0 ? -1 : tissue.locator->mesh().tet_region[static_cast<std::size_t>(tet)];
}

}  // namespace stylet

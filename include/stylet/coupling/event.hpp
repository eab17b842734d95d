// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace stylet {

/// Kinds of events during an insertion. The simulation detects retraction_start and slip_start, the coupling detects
/// all others.
enum class EventKind {
  skin_contact,      ///< the tip touches the skin
  puncture,          ///< the surface in front of the tip breaks
  region_entered,    ///< the tip enters a region
  retraction_start,  ///< the base begins to move outwards
  slip_start,        ///< after a turn outwards, more than half of the inserted shaft slides out and the hand pulls
  withdrawn,         ///< the needle has been drawn out of the patient
  bone_contact,      ///< the tip touches a rigid region
  exited,            ///< the tip leaves the tissue through the far side
  re_entered,        ///< the tip touches tissue again after it had exited
  grazed             ///< the tip slides off a surface that it meets at a grazing angle
};
const char* to_string(EventKind kind);

/// An event in one step of the coupling.
struct InsertionEvent {
  EventKind kind{};
  int region = -1;  ///< number of a region of the mesh; −1: the event has none
  /// Axial force of the hand at the moment of a puncture; NaN for all other events.
  double force_N = std::numeric_limits<double>::quiet_NaN();
  double passed = 1.0;  ///< share of the step that had passed: the end of the event's sub-step
};

}  // namespace stylet

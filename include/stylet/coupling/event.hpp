// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace stylet {

/// Kinds of events during an insertion. The simulation detects retraction_start and slip_start, the coupling detects
/// all others.
enum class EventKind {
  skin_contact,
  puncture,
  region_entered,
  retraction_start,
  slip_start,
  withdrawn,
  bone_contact,
  exited,
  re_entered,
  grazed
};
const char* to_string(EventKind kind);

/// An event in one step of the coupling.
struct InsertionEvent {
  EventKind kind{};
  int region = -1;  ///< number of the mesh's region, −1 where an event has
                    ///< none
  /// Axial force of the hand at the moment of a puncture; NaN for all other events.
  double force_N = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace stylet

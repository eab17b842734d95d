// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace stylet {

/// Things that happen to a needle. Where the hand turns back and where the shaft begins to slide out is noticed by the
/// simulation, all else by the coupling.
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

/// Something that happened in a step of the coupling.
struct InsertionEvent {
  EventKind kind{};
  int region = -1;                                            ///< of the mesh, −1 where it has no meaning
  double force_N = std::numeric_limits<double>::quiet_NaN();  ///< axial force of the hand at a puncture's very moment
};

}  // namespace stylet

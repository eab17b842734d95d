// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/step.hpp"

#include "stylet/coupling/event.hpp"

namespace stylet {

const char* to_string(TipState state) {
  switch (state) {
    case TipState::air:
      return "air";
    case TipState::pressing:
      return "pressing";
    case TipState::cutting:
      return "cutting";
    case TipState::in_track:
      return "in_track";
    case TipState::bone:
      return "bone";
    case TipState::exited:
      return "exited";
  }
  return "unknown";
}

const char* to_string(EventKind kind) {
  switch (kind) {
    case EventKind::skin_contact:
      return "skin_contact";
    case EventKind::puncture:
      return "puncture";
    case EventKind::region_entered:
      return "region_entered";
    case EventKind::retraction_start:
      return "retraction_start";
    case EventKind::slip_start:
      return "slip_start";
    case EventKind::withdrawn:
      return "withdrawn";
    case EventKind::bone_contact:
      return "bone_contact";
    case EventKind::exited:
      return "exited";
    case EventKind::re_entered:
      return "re_entered";
    case EventKind::grazed:
      return "grazed";
  }
  return "unknown";
}

}  // namespace stylet

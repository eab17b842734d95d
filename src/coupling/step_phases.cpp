// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/step_phases.hpp"

namespace stylet {

const char* to_string(StepPhase phase) {
  switch (phase) {
    case StepPhase::other:
      return "other";
    case StepPhase::needle_tangent:
      return "needle_tangent";
    case StepPhase::needle_relax:
      return "needle_relax";
    case StepPhase::needle_advance:
      return "needle_advance";
    case StepPhase::gather:
      return "gather";
    case StepPhase::factorise:
      return "factorise";
    case StepPhase::solve:
      return "solve";
    case StepPhase::balance:
      return "balance";
    case StepPhase::tip:
      return "tip";
    case StepPhase::contacts:
      return "contacts";
  }
  return "unknown";
}

}  // namespace stylet

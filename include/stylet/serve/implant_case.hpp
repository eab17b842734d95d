// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/evaluate.hpp"
#include "stylet/implant/needle_load.hpp"

#include <vector>

namespace stylet::serve {

/// The plan of a case whose needles the user carries out in the live page, and everything that its dose depends on.
struct ImplantCase {
  DosePlan plan;
  SourceModel source;
  std::vector<NeedleLoad> needles;  ///< in the order of the procedure
  /// The structures of the patient, sampled. The live page takes at most 20,000 samples of each.
  std::vector<DoseStructure> structures;
  DoseOptions options;  ///< goals and swelling

  /// The prescribed dose [Gy] of the options, otherwise of the plan; 0: none is known.
  [[nodiscard]] double prescription_Gy() const {
    return options.prescription_Gy > 0.0 ? options.prescription_Gy : plan.prescription_Gy;
  }
};

}  // namespace stylet::serve

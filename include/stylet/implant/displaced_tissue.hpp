// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"
#include "stylet/geom/displaced.hpp"
#include "stylet/implant/seed_history.hpp"

#include <span>

/// Seeds and structures in tissue that is displaced by something other than the needles, by a probe in the rectum
/// (docs/theory/implant.md). A displacement u is relative to the contours of the plan.
namespace stylet {

/// Lets the tissue go back from u, in which seeds were dropped, to where the contours of the plan have it. A seed whose
/// place of rest was x belongs to the material point X with X + u(X) = x, and comes to rest there; X − x is the part of
/// its error by SeedCause::probe. Its axis turns with the tissue at its ends. Lost seeds stay as they are.
/// @param locator of the mesh of the contours @param seed_length_mm length of a seed's capsule
void let_tissue_go_back(const Locator& locator, const NodalDisplacement& u, double seed_length_mm,
                        std::span<SeedHistory> seeds);

/// The seeds of a plan where displaced tissue takes them, with their axes.
/// @param seed_length_mm length of a seed's capsule
[[nodiscard]] DosePlan displaced(const Locator& locator, const NodalDisplacement& u, double seed_length_mm,
                                 DosePlan plan);

/// The samples of a structure where displaced tissue takes them; samples outside of the mesh stay. Contours stay, too.
/// The volumes are not changed by the strain.
[[nodiscard]] DoseStructure displaced(const Locator& locator, const NodalDisplacement& u, DoseStructure structure);

}  // namespace stylet

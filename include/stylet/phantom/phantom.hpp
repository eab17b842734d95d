// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/contours.hpp"

namespace stylet {

/// Options of demo_patient().
struct PhantomOptions {
  std::uint64_t seed = 0;         ///< varies the anatomy; 0 is the documented reference patient
  double slice_spacing_mm = 5.0;  ///< [mm] 1…8; values outside are clamped
};

/// The demo patient: contours on parallel transverse slices of prostate, urethra, bladder, rectum, pubic arch, stiff
/// band and body (perineal skin). Shapes follow published dimensions of the male pelvis (sources:
/// src/phantom/anatomy.hpp).
ContourSet demo_patient(const PhantomOptions& options = {});

}  // namespace stylet

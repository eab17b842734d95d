// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/contours.hpp"

namespace stylet {

struct PhantomOptions {
  std::uint64_t seed = 0;         ///< varies the anatomy; 0 is the documented reference patient
  double slice_spacing_mm = 5.0;  ///< [mm] 1…8; values outside are brought to the nearer end
};

/// The demo patient: contours on parallel transverse slices of prostate, urethra, bladder, rectum, pubic arch, stiff
/// band and body (perineal skin), shapes from published male-pelvis dimensions (sources in the implementation).
ContourSet demo_patient(const PhantomOptions& options = {});

}  // namespace stylet

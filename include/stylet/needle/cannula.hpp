// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

namespace stylet {

/// A needle's cross-section: a tube (cannula), and a wire in its lumen (stylet) or none.
struct Cannula {
  double outer_diameter_mm = 1.27;  ///< 18 gauge
  double lumen_diameter_mm = 1.0;   ///< 0 = a solid rod; thin-walled 18 gauge, lets seeds of 0.8 mm pass
  double young_MPa = 200e3;         ///< stainless steel
  double poisson = 0.3;
  double stylet_diameter_mm = 0.0;  ///< 0 = out
  double stylet_young_MPa = 200e3;
};

/// What a cross-section is worth.
struct SectionStiffness {
  double bending_Nmm2 = 0.0;  ///< E I
  double torsion_Nmm2 = 0.0;  ///< G J
  double axial_N = 0.0;       ///< E A
};

/// Stiffness of a section. With d_o, d_i the tube's diameters and d_s the stylet's,
///   EI = E π (d_o⁴ − d_i⁴)/64 + E_s π d_s⁴/64,   GJ = E/(1 + ν) π (d_o⁴ − d_i⁴)/64,   EA = E π (d_o² − d_i²)/4.
/// The stylet slides freely in the lumen: it must bend with the tube, each about its own axis, so bending stiffnesses
/// add; it need neither turn nor stretch with it, so GJ and EA are the tube's alone.
/// @return input error for diameters that do not fit into each other, and for numbers that are not finite or positive
Result<SectionStiffness> section_stiffness(const Cannula& cannula);

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

namespace stylet {

/// Cross-section of a needle: a tube (cannula), with or without a wire (stylet) in its lumen.
struct Cannula {
  double outer_diameter_mm = 1.27;  ///< [mm], 18 gauge
  /// [mm], 0 = a solid rod; the default is a thin-walled 18 gauge tube that lets seeds of 0.8 mm pass.
  double lumen_diameter_mm = 1.0;
  double young_MPa = 200e3;         ///< Young's modulus of the tube [MPa], stainless steel
  double poisson = 0.3;             ///< Poisson's ratio of the tube
  double stylet_diameter_mm = 0.0;  ///< [mm], 0 = no stylet
  double stylet_young_MPa = 200e3;  ///< Young's modulus of the stylet [MPa], stainless steel
};

/// Stiffness of a cross-section.
struct SectionStiffness {
  double bending_Nmm2 = 0.0;  ///< E I [N mm²]
  double torsion_Nmm2 = 0.0;  ///< G J [N mm²]
  double axial_N = 0.0;       ///< E A [N]
};

/// Stiffness of a cross-section. With the tube's diameters d_o, d_i and the stylet's diameter d_s,
///   EI = E π (d_o⁴ − d_i⁴)/64 + E_s π d_s⁴/64,   GJ = E/(1 + ν) π (d_o⁴ − d_i⁴)/64,   EA = E π (d_o² − d_i²)/4.
/// The stylet slides freely in the lumen. It must bend with the tube, each about its own axis, so the bending
/// stiffnesses add up. It need not turn or stretch with the tube, so GJ and EA are the values of the tube alone.
/// @return an input error for diameters that do not fit into each other, and for numbers that are not finite or not
///   positive
Result<SectionStiffness> section_stiffness(const Cannula& cannula);

}  // namespace stylet

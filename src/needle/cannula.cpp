// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/cannula.hpp"

#include "needle/number_text.hpp"

#include <cmath>
#include <numbers>

namespace stylet {

namespace {

/// Second moment of area of a disc [mm⁴], diameter in mm.
double disc(double diameter) { return std::numbers::pi * std::pow(diameter, 4) / 64.0; }

Error wrong(const char* name, const std::string& what, const char* cure) {
  return input_error(std::string("needle, ") + name, what, cure);
}

}  // namespace

Result<SectionStiffness> section_stiffness(const Cannula& c) {
  if (!is_positive(c.outer_diameter_mm)) return not_positive("outer diameter", "mm", c.outer_diameter_mm);
  if (!is_positive(c.young_MPa)) return not_positive("Young's modulus", "MPa", c.young_MPa);
  if (!(c.poisson > -1.0 && c.poisson <= 0.5))
    return wrong("Poisson's ratio", number_text(c.poisson) + ", expected more than -1 and at most 0.5",
                 "Give 0.3 for steel");
  if (!(c.lumen_diameter_mm >= 0.0 && c.lumen_diameter_mm < c.outer_diameter_mm))
    return wrong("lumen diameter",
                 number_text(c.lumen_diameter_mm) + " mm, expected 0 or more and less than the outer diameter, " +
                     number_text(c.outer_diameter_mm) + " mm",
                 "Give the tube's inner diameter, or 0 for a solid needle");
  if (!(c.stylet_diameter_mm >= 0.0 && c.stylet_diameter_mm <= c.lumen_diameter_mm))
    return wrong("stylet diameter",
                 number_text(c.stylet_diameter_mm) + " mm, expected 0 … " + number_text(c.lumen_diameter_mm) +
                     " mm, the diameter of the lumen it slides in",
                 "Give a thinner stylet or a wider lumen");
  if (c.stylet_diameter_mm > 0.0 && !is_positive(c.stylet_young_MPa))
    return not_positive("stylet's Young's modulus", "MPa", c.stylet_young_MPa);

  const double tube = disc(c.outer_diameter_mm) - disc(c.lumen_diameter_mm);
  SectionStiffness s;
  s.bending_Nmm2 = c.young_MPa * tube + c.stylet_young_MPa * disc(c.stylet_diameter_mm);
  s.torsion_Nmm2 = c.young_MPa / (1.0 + c.poisson) * tube;
  s.axial_N =
      c.young_MPa * 0.25 * std::numbers::pi * (std::pow(c.outer_diameter_mm, 2) - std::pow(c.lumen_diameter_mm, 2));
  return s;
}

}  // namespace stylet

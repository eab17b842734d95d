// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_choice.hpp"

namespace stylet {

namespace {
constexpr double kMPa_per_GPa = 1e3;
constexpr double kLumenShare = 1.0 / 1.27;  ///< lumen over outer diameter of a thin-walled 18 gauge needle
constexpr double kStyletShare = 0.9;        ///< stylet over lumen diameter, with room to slide; assumed, not measured
}  // namespace

Cannula cannula_of(const Scenario::NeedleChoice& choice) {
  Cannula c;
  c.outer_diameter_mm = choice.diameter_mm;
  c.lumen_diameter_mm = choice.lumen_diameter_mm.value_or(kLumenShare * choice.diameter_mm);
  c.young_MPa = choice.young_GPa * kMPa_per_GPa;
  c.stylet_young_MPa = choice.stylet_young_GPa * kMPa_per_GPa;
  if (choice.stylet == StyletPlace::in)
    c.stylet_diameter_mm = choice.stylet_diameter_mm.value_or(kStyletShare * c.lumen_diameter_mm);
  return c;
}

Result<NeedleSection> needle_section(const Scenario::NeedleChoice& choice) {
  const auto stiffness = section_stiffness(cannula_of(choice));
  if (!stiffness) return stiffness.error();
  NeedleSection section;
  section.length_mm = choice.length_mm;
  section.outer_diameter_mm = choice.diameter_mm;
  section.bending_stiffness_Nmm2 = choice.bending_stiffness_Nmm2.value_or(stiffness->bending_Nmm2);
  section.torsion_stiffness_Nmm2 = choice.torsion_stiffness_Nmm2.value_or(stiffness->torsion_Nmm2);
  section.bow_mm = choice.bow_mm;
  section.bow_deg = choice.bow_deg;
  return section;
}

double axial_compliance(const Scenario::NeedleChoice& choice) {
  return choice.length_mm / section_stiffness(cannula_of(choice)).value().axial_N;
}

}  // namespace stylet

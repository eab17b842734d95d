// SPDX-License-Identifier: GPL-3.0-or-later
// Bends a needle without tissue by a lateral force on its tip, and compares the deflection with beam theory.
#include <stylet/needle/beam.hpp>

#include <cmath>
#include <iostream>

int main() {
  const stylet::NeedleSection section;  // 18 gauge, 200 mm long, held at its base
  const auto needle = stylet::BeamNeedle::build(section, 24, 1);
  if (!needle) return std::cerr << needle.error().message() << '\n', 1;
  const stylet::PointLoad load{.s = section.length_mm, .force = {0.02, 0.0, 0.0}};
  const auto iterations = stylet::find_equilibrium(**needle, {&load, 1});
  if (!iterations) return std::cerr << iterations.error().message() << '\n', 1;
  const double bent_mm = (*needle)->point(section.length_mm).x() - (*needle)->base().origin.x();
  const double beam_mm = load.force.x() * std::pow(section.length_mm, 3) / (3.0 * section.bending_stiffness_Nmm2);
  std::cout << "0.02 N across the tip bend it by " << bent_mm << " mm; F L^3 / (3 E I) is " << beam_mm << " mm\n";
  return std::abs(bent_mm - beam_mm) < 0.01 * beam_mm ? 0 : 1;
}

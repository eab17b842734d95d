// SPDX-License-Identifier: GPL-3.0-or-later
// Inserts two needles, one after the other, through two holes of the template. Not a medical device.
#include <stylet/patient/insert.hpp>

#include <iostream>

int main() {
  stylet::Scenario scenario;
  scenario.patient.source = "phantom";  // the demo patient
  scenario.mesh.nodes = 800;            // a coarse mesh, so that the example is fast
  scenario.insertions = {{.hole = "e3.5"}, {.hole = "c3.5", .speed_mm_per_s = 50.0}};
  scenario.output.pictures = false;
  const auto prepared = stylet::prepare_model(scenario);
  if (!prepared) return std::cerr << prepared.error().message() << '\n', 2;
  const auto result = stylet::insert(*prepared, "out/several_needles");
  if (!result) return std::cerr << result.error().message() << '\n', 1;
  for (const auto& gland : result->summary.gland_motions)
    std::cout << "the gland moved by up to " << gland.shift_max_mm.norm() << " mm\n";
}

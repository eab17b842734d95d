// SPDX-License-Identifier: GPL-3.0-or-later
// Uses your own tissue values: effect of a stronger capsule on the force and on the gland. Not a medical device.
#include <stylet/patient/insert.hpp>

#include <iostream>

int main() {
  for (const double capsule_N : {3.0, 4.3}) {
    stylet::Scenario scenario;
    scenario.patient.source = "phantom";  // the demo patient
    scenario.mesh.nodes = 800;            // a coarse mesh, so that the example is fast
    scenario.insertions = {{.hole = "e3.5"}};
    scenario.output.pictures = false;
    stylet::TissueParameters gland = stylet::default_tissue("prostate");
    gland.puncture_N = capsule_N;
    gland.source = "example";  // shown in the report
    scenario.tissue["prostate"] = gland;
    const auto prepared = stylet::prepare_model(scenario);
    if (!prepared) return std::cerr << prepared.error().message() << '\n', 2;
    const auto result = stylet::insert(*prepared, "out/own_tissue");
    if (!result) return std::cerr << result.error().message() << '\n', 1;
    std::cout << "a capsule of " << capsule_N << " N: largest force " << result->summary.peak_axial_N
              << " N, gland moved by up to " << result->summary.gland->shift_max_mm.norm() << " mm\n";
  }
}

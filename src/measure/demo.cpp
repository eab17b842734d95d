// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/demo.hpp"

#include "stylet/phantom/phantom.hpp"

namespace stylet::measure {

Scenario demo_scenario() {
  Scenario scenario;
  scenario.name = "Demo: one needle into the left half of the prostate";
  scenario.patient.source = "phantom";
  scenario.fixed.outer = OuterSupport::sides;
  scenario.mesh.nodes = 3000;
  scenario.needle.lumen_diameter_mm = 1.0;
  scenario.needle.bevel_deg = 20.0;
  scenario.grid.guide = true;
  InsertionPlan plan;
  plan.hole = "e3.5";
  scenario.insertions.push_back(plan);
  return scenario;
}

Result<MeshedAnatomy> mesh_demo(Index nodes, const Progress& progress) {
  MeshOptions options;
  options.nodes = nodes;
  options.cull_tolerance_mm = demo_scenario().mesh.cull_mm;
  options.layers = demo_scenario().anatomy;
  return mesh_contours(demo_patient(), options, progress);
}

}  // namespace stylet::measure

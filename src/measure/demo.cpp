// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/demo.hpp"

#include "stylet/phantom/phantom.hpp"
#include "stylet/sim/supports.hpp"

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

Result<ProbedDemo> probed_demo(Index nodes, const Progress& progress) {
  Scenario scenario = demo_scenario();
  scenario.probe.kind = ProbeKind::biplane;
  auto meshed = mesh_demo(nodes, progress);
  if (!meshed) return meshed.error();
  TetMesh mesh = std::move(meshed->mesh);
  ProbedDemo demo;
  demo.topology = std::make_unique<const Topology>(mesh);
  std::vector<Material> materials;
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    const TissueParameters tissue = tissue_of(scenario, mesh.regions[r]);
    materials.push_back({tissue.young_kPa * 1e-3, tissue.poisson});
    if (is_target_region(mesh.regions[r])) demo.gland.push_back(static_cast<int>(r));
  }
  const Vec3 entry(15.0, 3.0, -52.0);  // of the demo's needle, around which the skin is free
  const auto supports = find_supports(mesh, *demo.topology, scenario.fixed, demo.gland, {entry}, {Vec3(Vec3::UnitZ())});
  if (!supports) return supports.error();
  auto tissue =
      Tissue::build(std::move(mesh), std::move(materials), supports->nodes, progress, Element::nodal_pressure);
  if (!tissue) return tissue.error();
  demo.tissue = std::make_unique<const Tissue>(std::move(*tissue));
  return demo;
}

}  // namespace stylet::measure

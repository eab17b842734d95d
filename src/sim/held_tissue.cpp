// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/held_tissue.hpp"

#include "planning.hpp"
#include "stylet/sim/supports.hpp"
#include "tissue_choice.hpp"

namespace stylet {

Result<HeldTissue> hold_tissue(const Scenario& scenario, TetMesh mesh, const std::string& where,
                               const Progress& progress) {
  HeldTissue held;
  held.target = find_target(mesh);
  auto topology = std::make_shared<const Topology>(mesh);
  std::vector<Vec3> entries, directions;
  {
    const Locator locator(mesh, *topology);
    for (std::size_t i = 0; i < scenario.insertions.size(); ++i) {
      if (!scenario.insertions[i].motion.empty()) continue;
      const auto planned = plan_insertion(scenario.insertions[i], i, scenario, locator, held.target, where);
      if (!planned) continue;
      entries.push_back(planned->entry);
      directions.push_back(planned->direction);
    }
  }
  const auto supports = find_supports(mesh, *topology, scenario.fixed, held.target, entries, directions);
  if (!supports) return within(where, supports.error());
  report(progress, "factorising the tissue", 0.0);
  const Element element = element_of(scenario, mesh.node_count());
  std::vector<Material> materials = materials_of(tissue_parameters(scenario, mesh));
  auto tissue = Tissue::build(std::move(mesh), std::move(materials), supports->nodes, progress, element);
  if (!tissue) return within(where, tissue.error());
  held.tissue = std::make_shared<const Tissue>(std::move(*tissue));
  held.topology = std::move(topology);
  held.locator = std::make_shared<const Locator>(held.tissue->mesh(), *held.topology);
  return held;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_choice.hpp"

#include "room_for_probe.hpp"

namespace stylet {

std::vector<TissueParameters> tissue_parameters(const Scenario& scenario, const TetMesh& mesh) {
  std::vector<TissueParameters> regions;
  for (const std::string& name : mesh.regions) {
    TissueParameters p = tissue_of(scenario, name);
    if (name == "rectum" && scenario.probe.kind != ProbeKind::none && mesh.region_index("rectal_lumen") < 0 &&
        scenario.tissue.find(name) == scenario.tissue.end()) {
      make_room_for_probe(p);  // wall and filling are one region
    }
    regions.push_back(p);
  }
  return regions;
}

std::vector<Material> materials_of(std::span<const TissueParameters> regions) {
  std::vector<Material> materials;
  for (const TissueParameters& p : regions) materials.push_back({p.young_kPa * 1e-3, p.poisson});
  return materials;
}

Element element_of(const Scenario& s, Index nodes) {
  const bool of_the_paper = s.coupling.method != CouplingSettings::Method::near_field ||
                            s.coupling.engine != CouplingSettings::Engine::condensed;
  const bool p1 = of_the_paper || nodes > kMostAveraged;
  return element_named(word(s.tissue_model.element)).value_or(p1 ? Element::p1 : Element::nodal_pressure);
}

}  // namespace stylet

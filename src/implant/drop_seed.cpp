// SPDX-License-Identifier: GPL-3.0-or-later
#include "drop_seed.hpp"

namespace stylet {

std::optional<FoundMaterial> material_at(const Vec3& place, const DisplacementAt& displacement) {
  MaterialSearch search(place);
  while (!search.is_done()) search.add(displacement(search.x()));
  return search.found();
}

DisplacementAt displacement_in(Simulation& simulation) {
  return [&simulation](const Vec3& x) -> std::optional<Insertion::PointDisplacement> {
    const auto at = simulation.model().locator().find(x);
    if (!at) return std::nullopt;
    return simulation.displacement_at(*at, x);
  };
}

}  // namespace stylet

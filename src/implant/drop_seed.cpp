// SPDX-License-Identifier: GPL-3.0-or-later
#include "drop_seed.hpp"

namespace stylet {

std::optional<FoundMaterial> material_at(const Vec3& place, const DisplacementAt& displacement) {
  MaterialSearch search(place);
  while (!search.is_done()) search.add(displacement(search.x()));
  return search.found();
}

TissueAt tissue_of_capsule(const Vec3& centre, const Vec3& axis, double length_mm, const DisplacementAt& displacement) {
  TissueAt tissue{.rest_mm = centre, .axis = axis};
  if (const auto at = material_at(centre, displacement)) {
    tissue.is_known = true;
    // The distance by which the nearest material point misses the place counts as motion of the tissue.
    tissue.rest_mm = centre - at->moved.whole;
    tissue.lasting_mm = at->moved.lasting;
  }
  const Vec3 half = 0.5 * length_mm * axis;
  const auto front = material_at(centre + half, displacement);
  const auto back = material_at(centre - half, displacement);
  if (front && back && (front->x - back->x).norm() > 0.0) tissue.axis = (front->x - back->x).normalized();
  return tissue;
}

DisplacementAt displacement_in(Simulation& simulation) {
  return [&simulation](const Vec3& x) -> std::optional<Insertion::PointDisplacement> {
    const auto at = simulation.model().locator().find(x);
    if (!at) return std::nullopt;
    return simulation.displacement_at(*at, x);
  };
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/moment.hpp"

namespace stylet {

ShownNeedle shown_needle(double diameter_mm, std::optional<double> lumen_diameter_mm) {
  const ShownNeedle gauge_18;
  ShownNeedle needle;
  needle.diameter_mm = diameter_mm;
  needle.lumen_diameter_mm =
      lumen_diameter_mm.value_or(gauge_18.lumen_diameter_mm / gauge_18.diameter_mm * diameter_mm);
  return needle;
}

void join_to_last(std::vector<ShownSeed>& seeds, bool same_strand) {
  if (same_strand && !seeds.empty()) seeds.back().next = seeds.size();
}

Moment moment_at_rest(const TetMesh& mesh) {
  Moment moment;
  moment.displacement = Eigen::Matrix3Xf::Zero(3, mesh.node_count());
  return moment;
}

}  // namespace stylet

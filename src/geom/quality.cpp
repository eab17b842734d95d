// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace stylet {
namespace {

Range empty_range() { return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}; }

void extend(Range& range, double value) {
  range.min = std::min(range.min, value);
  range.max = std::max(range.max, value);
}

// Radius of the sphere through the four corners: |a² (b×c) + b² (c×a) + c² (a×b)| / (2 |a·(b×c)|), the corners
// relative to the first.
double circumradius(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 numerator = a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  return numerator.norm() / (2.0 * std::abs(a.dot(b.cross(c))));
}

}  // namespace

MeshQuality mesh_quality(const TetMesh& mesh) {
  MeshQuality quality;
  quality.nodes = mesh.node_count();
  quality.tets = mesh.tet_count();
  quality.region_volume_cc.assign(mesh.regions.size(), 0.0);
  quality.region_tets.assign(mesh.regions.size(), 0);
  if (mesh.tets.empty()) return quality;

  quality.dihedral_deg = empty_range();
  quality.edge_mm = empty_range();
  quality.radius_ratio_min = 1.0;
  Index below_12_deg = 0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto& tet = mesh.tets[t];
    const double volume = tet_volume(mesh, t);
    quality.region_volume_cc[mesh.tet_region[t]] += volume / 1000.0;
    ++quality.region_tets[mesh.tet_region[t]];

    // The gradient of a barycentric coordinate is normal to the face it vanishes on; its length is 1 / height.
    const auto gradients = barycentric_gradients(mesh, t);
    double smallest = 180.0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        const Vec3 gi = gradients.col(i);
        const Vec3 gj = gradients.col(j);
        const double angle = std::atan2(gi.cross(gj).norm(), -gi.dot(gj)) * 180.0 / std::numbers::pi;
        extend(quality.dihedral_deg, angle);
        smallest = std::min(smallest, angle);
        ++quality.dihedral_histogram[std::min<std::size_t>(17, static_cast<std::size_t>(angle / 10.0))];
        extend(quality.edge_mm, (mesh.nodes[tet[i]] - mesh.nodes[tet[j]]).norm());
      }
    }
    if (smallest < 12.0) ++below_12_deg;

    const Vec3& origin = mesh.nodes[tet[0]];
    // r_in = 3 V / Σ A_i = 1 / Σ (1 / h_i)
    const double inradius = 1.0 / gradients.colwise().norm().sum();
    const double ratio =
        3.0 * inradius /
        circumradius(mesh.nodes[tet[1]] - origin, mesh.nodes[tet[2]] - origin, mesh.nodes[tet[3]] - origin);
    // Not std::min, which would let the NaN of a flat element pass.
    if (!(ratio >= quality.radius_ratio_min)) quality.radius_ratio_min = std::isnan(ratio) ? 0.0 : ratio;
  }
  quality.fraction_below_12_deg = static_cast<double>(below_12_deg) / quality.tets;
  return quality;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/quality.hpp"

#include "stylet/geom/flat_tets.hpp"

#include <fmt/format.h>

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

// Radius of the sphere through the four corners: |a² (b×c) + b² (c×a) + c² (a×b)| / (2 |a·(b×c)|), where a, b and c are
// the positions of three corners relative to the fourth.
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

    double smallest = 180.0;
    for (const double angle : dihedral_angles_deg(mesh, t)) {
      extend(quality.dihedral_deg, angle);
      smallest = std::min(smallest, angle);
      ++quality.dihedral_histogram[std::min<std::size_t>(17, static_cast<std::size_t>(angle / 10.0))];
    }
    if (smallest < 12.0) ++below_12_deg;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) extend(quality.edge_mm, (mesh.nodes[tet[i]] - mesh.nodes[tet[j]]).norm());
    }

    const Vec3& origin = mesh.nodes[tet[0]];
    // The gradient of a barycentric coordinate has the length 1 / height: r_in = 3 V / Σ A_i = 1 / Σ (1 / h_i)
    const double inradius = 1.0 / barycentric_gradients(mesh, t).colwise().norm().sum();
    const double ratio =
        3.0 * inradius /
        circumradius(mesh.nodes[tet[1]] - origin, mesh.nodes[tet[2]] - origin, mesh.nodes[tet[3]] - origin);
    // std::min would ignore the NaN of a flat element.
    if (!(ratio >= quality.radius_ratio_min)) quality.radius_ratio_min = std::isnan(ratio) ? 0.0 : ratio;
  }
  quality.fraction_below_12_deg = static_cast<double>(below_12_deg) / quality.tets;
  return quality;
}

std::array<double, 6> dihedral_angles_deg(const TetMesh& mesh, Index t) {
  // The gradient of a barycentric coordinate is normal to the face it vanishes on.
  const auto gradients = barycentric_gradients(mesh, t);
  std::array<double, 6> angles{};
  std::size_t k = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const Vec3 gi = gradients.col(i);
      const Vec3 gj = gradients.col(j);
      angles[k++] = std::atan2(gi.cross(gj).norm(), -gi.dot(gj)) * 180.0 / std::numbers::pi;
    }
  }
  return angles;
}

NearlyFlatTets nearly_flat_tets(const TetMesh& mesh) {
  NearlyFlatTets flat;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto angles = dihedral_angles_deg(mesh, t);
    const double smallest = *std::min_element(angles.begin(), angles.end());
    if (smallest >= kNearlyFlat_deg) continue;
    if (flat.count++ > 0 && smallest >= flat.angle_deg) continue;
    flat.worst = t;
    flat.angle_deg = smallest;
  }
  return flat;
}

std::string nearly_flat_warning(const TetMesh& mesh) {
  const NearlyFlatTets flat = nearly_flat_tets(mesh);
  if (flat.count == 0) return {};
  const auto& tet = mesh.tets[flat.worst];
  const Vec3 at = 0.25 * (mesh.nodes[tet[0]] + mesh.nodes[tet[1]] + mesh.nodes[tet[2]] + mesh.nodes[tet[3]]);
  return fmt::format(
      "{} of {} tetrahedra {} nearly flat, with a dihedral angle below {:g}°; the worst is tetrahedron {} (numbers "
      "start at 0) with {:.2g}°, at ({:.1f}, {:.1f}, {:.1f}) mm in '{}'. Displacements and forces near such "
      "tetrahedra are inaccurate. Improve the mesh with the meshing program's optimiser, or mesh the body again.",
      flat.count, mesh.tet_count(), flat.count == 1 ? "is" : "are", kNearlyFlat_deg, flat.worst, flat.angle_deg, at.x(),
      at.y(), at.z(), mesh.regions[static_cast<std::size_t>(mesh.tet_region[flat.worst])]);
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/tied_surface.hpp"

#include <algorithm>
#include <limits>

namespace stylet {

namespace {

/// The element that holds a point, or behind whose face it lies.
MaterialPoint holder(const Locator& locator, const Vec3& x, Index hint, const Vec3& middle) {
  if (const auto found = locator.find(x, hint)) return *found;
  if (const auto entry = locator.first_entry(x, middle)) return {entry->tet, locator.weights(entry->tet, x)};
  const TetMesh& mesh = locator.mesh();
  MaterialPoint nearest;
  double least = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const Vec4 weights = locator.weights(t, x);
    if (const double outside = -weights.minCoeff(); outside < least) {
      least = outside;
      nearest = {t, weights};
    }
  }
  return nearest;
}

}  // namespace

std::vector<Vec3> TiedSurface::positions(const TetMesh& mesh, const VecX& displacement) const {
  std::vector<Vec3> places(nodes.size(), Vec3::Zero());
  for (std::size_t n = 0; n < places.size(); ++n) {
    for (int k = 0; k < 4; ++k) {
      const Index node = nodes[n][static_cast<std::size_t>(k)];
      places[n] += weights[n][k] * (mesh.nodes[static_cast<std::size_t>(node)] + displacement.segment<3>(3 * node));
    }
  }
  return places;
}

std::vector<TiedSurface> tie_surfaces(const Locator& locator) {
  const TetMesh& mesh = locator.mesh();
  Eigen::AlignedBox3d box;
  for (const Vec3& x : mesh.nodes) box.extend(x);
  std::vector<TiedSurface> tied;
  for (const Surface& surface : mesh.surfaces) {
    TiedSurface out{
        .region = static_cast<int>(tied.size()), .nodes = {}, .weights = {}, .triangles = surface.triangles};
    Index hint = -1;
    for (const Vec3& x : surface.points) {
      const MaterialPoint at = holder(locator, x, hint, box.center());
      hint = at.tet;
      out.nodes.push_back(mesh.tets[static_cast<std::size_t>(at.tet)]);
      out.weights.push_back(at.weights);
    }
    tied.push_back(std::move(out));
  }
  return tied;
}

}  // namespace stylet

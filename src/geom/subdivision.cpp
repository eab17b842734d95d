// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/subdivision.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace stylet {

namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Local numbers of the corners of the eight parts: 0 … 3 are the corners of the parent, 4 … 9 the middles of kEdges.
/// The order makes the volume of each part positive if that of the parent is. The diagonal of the octahedron joins the
/// middles of the edges 02 and 13.
constexpr std::array<std::array<int, 4>, 8> kParts{
    {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}, {4, 5, 6, 8}, {4, 7, 5, 8}, {5, 9, 6, 8}, {5, 7, 9, 8}}};

/// Barycentric coordinates of a part's corners in the parent (4 × 4, one column each).
Eigen::Matrix4d corners_of(const std::array<int, 4>& part) {
  Eigen::Matrix4d corners = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 4; ++i) {
    const int local = part[static_cast<std::size_t>(i)];
    if (local < 4) {
      corners(local, i) = 1.0;
      continue;
    }
    for (const int end : kEdges[static_cast<std::size_t>(local - 4)]) corners(end, i) = 0.5;
  }
  return corners;
}

}  // namespace

Subdivision subdivide(const TetMesh& mesh) {
  Subdivision result;
  const auto edge = [&](const std::array<Index, 4>& tet, std::size_t e) {
    const Index a = tet[static_cast<std::size_t>(kEdges[e][0])];
    const Index b = tet[static_cast<std::size_t>(kEdges[e][1])];
    return std::array{std::min(a, b), std::max(a, b)};
  };
  auto& ends = result.ends;
  ends.reserve(6 * mesh.tets.size());
  for (const auto& tet : mesh.tets) {
    for (std::size_t e = 0; e < kEdges.size(); ++e) ends.push_back(edge(tet, e));
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());

  result.mesh.regions = mesh.regions;
  result.mesh.nodes = mesh.nodes;
  for (const auto& [a, b] : ends) {
    result.mesh.nodes.emplace_back(0.5 *
                                   (mesh.nodes[static_cast<std::size_t>(a)] + mesh.nodes[static_cast<std::size_t>(b)]));
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<Index, 10> local{};
    std::copy(mesh.tets[t].begin(), mesh.tets[t].end(), local.begin());
    for (std::size_t e = 0; e < kEdges.size(); ++e) {
      const auto found = std::lower_bound(ends.begin(), ends.end(), edge(mesh.tets[t], e));
      local[4 + e] = mesh.node_count() + static_cast<Index>(found - ends.begin());
    }
    for (const auto& part : kParts) {
      auto& tet = result.mesh.tets.emplace_back();
      for (std::size_t i = 0; i < 4; ++i) tet[i] = local[static_cast<std::size_t>(part[i])];
      result.mesh.tet_region.push_back(mesh.tet_region[t]);
    }
  }
  return result;
}

MaterialPoint in_subdivision(const MaterialPoint& at) {
  static const std::array<Eigen::Matrix4d, 8> inverse = [] {
    std::array<Eigen::Matrix4d, 8> matrices;
    for (std::size_t k = 0; k < matrices.size(); ++k) matrices[k] = corners_of(kParts[k]).inverse();
    return matrices;
  }();
  MaterialPoint best;
  double furthest_in = -1e300;
  for (std::size_t k = 0; k < inverse.size(); ++k) {
    const Vec4 weights = inverse[k] * at.weights;
    if (weights.minCoeff() <= furthest_in) continue;
    furthest_in = weights.minCoeff();
    best = {static_cast<Index>(8 * at.tet + static_cast<Index>(k)), weights};
  }
  return best;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "supports.hpp"

#include <cstdio>
#include <numeric>

namespace stylet::detail {
namespace {

std::string point(const Vec3& x) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) mm", x[0], x[1], x[2]);
  return text;
}

constexpr const char* kCure = "Fix at least three nodes that are not on a line in every connected part of the mesh";

// Number of the connected part to which each node belongs; parts are numbered in the order of their lowest nodes.
std::vector<Index> connected_parts(const TetMesh& mesh, Index& parts) {
  std::vector<Index> root(mesh.nodes.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](Index a) {
    while (root[a] != a) a = root[a] = root[root[a]];
    return a;
  };
  for (const auto& tet : mesh.tets) {
    for (int i = 1; i < 4; ++i) {
      const Index a = find(tet[0]);
      const Index b = find(tet[i]);
      // Keeping the lower number as the root orders the parts.
      root[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<Index> part(mesh.nodes.size(), -1);
  parts = 0;
  for (Index a = 0; a < mesh.node_count(); ++a) {
    const Index r = find(a);
    part[a] = r == a ? parts++ : part[r];
  }
  return part;
}

// Whether three of the points are not on a line, to a millionth of their spread.
bool span_a_plane(const std::vector<Vec3>& points) {
  if (points.size() < 3) return false;
  const auto farthest = [&points](const auto& distance) {
    double most = 0.0;
    Vec3 at = points.front();
    for (const Vec3& x : points) {
      if (distance(x) > most) most = distance(x), at = x;
    }
    return std::pair(at, most);
  };
  const Vec3 origin = points.front();
  const auto [tip, length] = farthest([&](const Vec3& x) { return (x - origin).norm(); });
  if (length == 0.0) return false;
  const Vec3 along = (tip - origin) / length;
  return farthest([&](const Vec3& x) { return along.cross(x - origin).norm(); }).second > 1e-6 * length;
}

}  // namespace

Result<> check_supports(const TetMesh& mesh, const std::vector<char>& is_fixed) {
  Index parts = 0;
  const auto part = connected_parts(mesh, parts);
  std::vector<std::vector<Vec3>> held(parts);
  std::vector<Index> size(parts, 0);
  std::vector<Vec3> centre(parts, Vec3::Zero());
  for (Index a = 0; a < mesh.node_count(); ++a) {
    ++size[part[a]];
    centre[part[a]] += mesh.nodes[a];
    if (is_fixed[a]) held[part[a]].push_back(mesh.nodes[a]);
  }
  for (Index p = 0; p < parts; ++p) {
    if (span_a_plane(held[p])) continue;
    const std::string how_held = held[p].empty()       ? "none of its nodes is fixed"
                                 : held[p].size() == 1 ? "only 1 of its nodes is fixed"
                                 : held[p].size() == 2
                                     ? "only 2 of its nodes are fixed"
                                     : "its " + std::to_string(held[p].size()) + " fixed nodes lie on one line";
    const std::string which = parts == 1 ? "the tissue is not held: "
                                         : "part " + std::to_string(p + 1) + " of " + std::to_string(parts) +
                                               " of the tissue (" + std::to_string(size[p]) + " nodes around " +
                                               point(centre[p] / size[p]) + ") is not held: ";
    return input_error("supports", which + how_held, kCure);
  }
  return Ok{};
}

Error loose_part(const TetMesh& mesh, Index loose) {
  return input_error("supports",
                     "the tissue is not held: the part with node " + std::to_string(loose) + " at " +
                         point(mesh.nodes[loose]) +
                         " can move without deforming; it may hang on to the rest by a single node or edge",
                     kCure);
}

}  // namespace stylet::detail

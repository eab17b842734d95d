// SPDX-License-Identifier: GPL-3.0-or-later
#include "pieces.hpp"

#include "editable_mesh.hpp"

#include <algorithm>

namespace stylet::meshing {

double drop_loose_pieces(RawMesh& mesh, int body) {
  const EditableMesh m(mesh);
  const std::size_t count = mesh.tets.size();
  std::vector<int> piece(count, -1);
  std::vector<std::vector<Index>> pieces;
  for (std::size_t start = 0; start < count; ++start) {
    if (piece[start] >= 0) continue;
    const int p = static_cast<int>(pieces.size());
    std::vector<Index> open{static_cast<Index>(start)};
    pieces.emplace_back();
    piece[start] = p;
    while (!open.empty()) {
      const Index t = open.back();
      open.pop_back();
      pieces[p].push_back(t);
      const auto& n = mesh.tets[t];
      for (int i = 0; i < 4; ++i) {
        const Index other = m.across(t, {n[(i + 1) % 4], n[(i + 2) % 4], n[(i + 3) % 4]});
        if (other < 0 || piece[other] >= 0) continue;
        piece[other] = p;
        open.push_back(other);
      }
    }
  }
  if (pieces.size() == 1) return 0;
  const auto largest =
      std::max_element(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  double dropped = 0;
  std::vector<bool> keep(count, false);
  for (auto p = pieces.begin(); p != pieces.end(); ++p) {
    const bool organ = std::any_of(p->begin(), p->end(), [&](Index t) { return mesh.label[t] != body; });
    // An organ consists of at least some elements; fewer are a splinter of a surface.
    const bool stays = p == largest || (organ && p->size() >= 20);
    for (const Index t : *p) {
      keep[t] = stays;
      if (stays) continue;
      const auto& n = mesh.tets[t];
      const Vec3& a = mesh.nodes[n[0]];
      dropped += (mesh.nodes[n[1]] - a).cross(mesh.nodes[n[2]] - a).dot(mesh.nodes[n[3]] - a) / 6;
    }
  }
  RawMesh rest;
  std::vector<Index> number(mesh.nodes.size(), -1);
  for (std::size_t t = 0; t < count; ++t) {
    if (!keep[t]) continue;
    std::array<Index, 4> tet{};
    for (int i = 0; i < 4; ++i) {
      Index& k = number[mesh.tets[t][i]];
      if (k < 0) {
        k = static_cast<Index>(rest.nodes.size());
        rest.nodes.push_back(mesh.nodes[mesh.tets[t][i]]);
      }
      tet[i] = k;
    }
    rest.tets.push_back(tet);
    rest.label.push_back(mesh.label[t]);
  }
  mesh = std::move(rest);
  return dropped;
}

}  // namespace stylet::meshing

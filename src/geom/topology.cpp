// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/topology.hpp"

#include "face_table.hpp"

namespace stylet {

Topology::Topology(const TetMesh& mesh) {
  neighbour.assign(mesh.tets.size(), {-1, -1, -1, -1});
  const auto sides = detail::sorted_face_sides(mesh);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const auto& p = sides[i];
    const auto& q = sides[i + 1];
    if (p.key != q.key) continue;
    neighbour[p.tet][p.local] = q.tet;
    neighbour[q.tet][q.local] = p.tet;
    ++i;  // in a checked mesh, a face has at most two sides
  }

  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (int local = 0; local < 4; ++local) {
      const Index other = neighbour[t][local];
      const bool outer = other < 0;
      if (!outer && mesh.tet_region[other] <= mesh.tet_region[t]) continue;
      const auto& corner = kFaceVertices[local];
      const auto& tet = mesh.tets[t];
      (outer ? boundary : interfaces).push_back({{tet[corner[0]], tet[corner[1]], tet[corner[2]]}, t, local, other});
    }
  }

  std::vector<Index> count(mesh.nodes.size(), 0);
  for (const auto& tet : mesh.tets) {
    for (const Index a : tet) ++count[a];
  }
  node_tets.resize(mesh.nodes.size());
  for (std::size_t a = 0; a < node_tets.size(); ++a) node_tets[a].reserve(count[a]);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (const Index a : mesh.tets[t]) node_tets[a].push_back(t);
  }
}

}  // namespace stylet

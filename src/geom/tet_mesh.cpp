// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

int TetMesh::region_index(std::string_view name) const {
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (regions[r] == name) return static_cast<int>(r);
  }
  return -1;
}

double tet_volume(const TetMesh& mesh, Index t) {
  const auto& tet = mesh.tets[t];
  const Vec3& origin = mesh.nodes[tet[0]];
  const Vec3 a = mesh.nodes[tet[1]] - origin;
  const Vec3 b = mesh.nodes[tet[2]] - origin;
  const Vec3 c = mesh.nodes[tet[3]] - origin;
  return a.cross(b).dot(c) / 6.0;
}

Eigen::Matrix<double, 3, 4> barycentric_gradients(const TetMesh& mesh, Index t) {
  const auto& tet = mesh.tets[t];
  const Vec3& origin = mesh.nodes[tet[0]];
  const Vec3 a = mesh.nodes[tet[1]] - origin;
  const Vec3 b = mesh.nodes[tet[2]] - origin;
  const Vec3 c = mesh.nodes[tet[3]] - origin;
  const double six_volumes = a.cross(b).dot(c);
  Eigen::Matrix<double, 3, 4> g;
  g.col(1) = b.cross(c) / six_volumes;
  g.col(2) = c.cross(a) / six_volumes;
  g.col(3) = a.cross(b) / six_volumes;
  g.col(0) = -(g.col(1) + g.col(2) + g.col(3));
  return g;
}

}  // namespace stylet

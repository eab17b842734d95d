// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace stylet {
namespace {

TetMesh layered_box() {
  TetMesh mesh = box_mesh({0, 0, 0}, {40, 30, 20}, {4, 3, 2}, 0.1);
  // The upper layer has the lower region number, so the orders of regions and of elements differ.
  assign_regions(mesh, {"upper", "lower"}, [](const Vec3& x) { return x.z() < 10 ? 1 : 0; });
  return mesh;
}

Vec3 area_vector(const TetMesh& mesh, const Face& face) {
  const Vec3& a = mesh.nodes[face.nodes[0]];
  return 0.5 * (mesh.nodes[face.nodes[1]] - a).cross(mesh.nodes[face.nodes[2]] - a);
}

TEST(Topology, neighbours_are_mutual_and_share_three_nodes) {
  const TetMesh mesh = layered_box();
  const Topology topology(mesh);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (int i = 0; i < 4; ++i) {
      const Index other = topology.neighbour[t][i];
      if (other < 0) continue;
      const auto& back = topology.neighbour[other];
      EXPECT_EQ(std::count(back.begin(), back.end(), t), 1);
      for (int k = 0; k < 4; ++k) {
        const bool shared =
            std::find(mesh.tets[other].begin(), mesh.tets[other].end(), mesh.tets[t][k]) != mesh.tets[other].end();
        EXPECT_EQ(shared, k != i);
      }
    }
  }
}

TEST(Topology, boundary_is_closed_outward_and_complete) {
  const TetMesh mesh = layered_box();
  const Topology topology(mesh);
  EXPECT_EQ(topology.boundary.size(), 2u * 2 * (4 * 3 + 3 * 2 + 2 * 4));
  Vec3 total = Vec3::Zero();
  double six_volumes = 0.0;
  for (const Face& face : topology.boundary) {
    EXPECT_EQ(face.neighbour, -1);
    const Vec3 area = area_vector(mesh, face);
    EXPECT_GT(area.dot(mesh.nodes[face.nodes[0]] - mesh.nodes[mesh.tets[face.tet][face.local]]), 0.0);
    total += area;
    six_volumes += 2.0 * area.dot(mesh.nodes[face.nodes[0]]);
  }
  EXPECT_LT(total.norm(), 1e-10);
  EXPECT_NEAR(six_volumes / 6.0, 40.0 * 30.0 * 20.0, 1e-8);
}

TEST(Topology, interfaces_are_listed_once_from_the_lower_region) {
  const TetMesh mesh = layered_box();
  const Topology topology(mesh);
  std::set<std::array<Index, 3>> seen;
  Vec3 total = Vec3::Zero();
  for (const Face& face : topology.interfaces) {
    EXPECT_EQ(mesh.tet_region[face.tet], 0);
    EXPECT_EQ(mesh.tet_region[face.neighbour], 1);
    EXPECT_EQ(topology.neighbour[face.tet][face.local], face.neighbour);
    auto key = face.nodes;
    std::sort(key.begin(), key.end());
    EXPECT_TRUE(seen.insert(key).second);
    total += area_vector(mesh, face);
  }
  // The outer edge of the layer lies in the plane z = 10 and closes the surface: its area vector is that of the
  // section.
  EXPECT_LT((total - Vec3(0, 0, -40.0 * 30.0)).norm(), 1e-9);
}

TEST(Topology, node_tets_list_every_element_of_every_node) {
  const TetMesh mesh = layered_box();
  const Topology topology(mesh);
  std::size_t entries = 0;
  for (Index a = 0; a < mesh.node_count(); ++a) {
    EXPECT_TRUE(std::is_sorted(topology.node_tets[a].begin(), topology.node_tets[a].end()));
    for (const Index t : topology.node_tets[a]) {
      EXPECT_NE(std::find(mesh.tets[t].begin(), mesh.tets[t].end(), a), mesh.tets[t].end());
    }
    entries += topology.node_tets[a].size();
  }
  EXPECT_EQ(entries, 4 * mesh.tets.size());
}

}  // namespace
}  // namespace stylet

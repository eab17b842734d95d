// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/fine_surface.hpp"

#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"

#include <gtest/gtest.h>

#include <map>

namespace stylet {
namespace {

/// Outer faces and interface of a box of two regions, as patches 0 and 1, and a needle's way through both.
struct Surfaces {
  TetMesh mesh = box_mesh({0, 0, 0}, {30, 30, 30}, {4, 4, 4}, 0.15);
  std::vector<std::array<Index, 3>> triangles;
  std::vector<int> patch;
  LineSegment way{Vec3(13.1, 16.3, -5.0), Vec3(14.0, 15.0, 35.0)};

  Surfaces() {
    assign_regions(mesh, {"body", "prostate"}, [](const Vec3& x) { return x.z() < 15.0 ? 0 : 1; });
    const Topology topology(mesh);
    for (const Face& face : topology.boundary) add(face, 0);
    for (const Face& face : topology.interfaces) add(face, 1);
  }
  void add(const Face& face, int number) {
    triangles.push_back(face.nodes);
    patch.push_back(number);
  }
  [[nodiscard]] FineSurface refined() const { return refine_surface(mesh.nodes, triangles, patch, std::span(&way, 1)); }
};

Vec3 doubled_area(const FineSurface& s, std::size_t t) {
  const auto at = [&](int k) {
    return s.positions[static_cast<std::size_t>(s.triangles[t][static_cast<std::size_t>(k)])];
  };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

TEST(FineSurface, is_as_large_as_it_was_and_faces_the_same_way) {
  const Surfaces given;
  const FineSurface fine = given.refined();
  const FineSurface coarse = refine_surface(given.mesh.nodes, given.triangles, given.patch, {});
  ASSERT_EQ(coarse.triangles.size(), given.triangles.size());
  ASSERT_GT(fine.triangles.size(), coarse.triangles.size() + 100);
  for (const int patch : {0, 1}) {
    const auto sums = [&](const FineSurface& s) {
      std::pair<double, Vec3> sum{0.0, Vec3::Zero()};
      for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        if (s.patch[t] != patch) continue;
        sum.first += doubled_area(s, t).norm();
        sum.second += doubled_area(s, t);
      }
      return sum;
    };
    EXPECT_NEAR(sums(fine).first, sums(coarse).first, 1e-9 * sums(coarse).first);
    EXPECT_LT((sums(fine).second - sums(coarse).second).norm(), 1e-9 * sums(coarse).first);
  }
}

TEST(FineSurface, stays_closed) {
  const Surfaces given;
  const FineSurface fine = given.refined();
  std::map<std::pair<Index, Index>, int> edges;  // edges of the outer surface: each occurs once in each direction
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    if (fine.patch[t] != 0) continue;
    for (std::size_t k = 0; k < 3; ++k) ++edges[{fine.triangles[t][k], fine.triangles[t][(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first})) << "a gap at an edge";
  }
}

TEST(FineSurface, has_a_point_where_the_line_goes_through_and_short_edges_there) {
  const Surfaces given;
  const FineSurface fine = given.refined();
  for (const int patch : {0, 1}) {
    double nearest = 1e9;
    double longest = 0.0;
    for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
      if (fine.patch[t] != patch) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = fine.positions[static_cast<std::size_t>(fine.triangles[t][k])];
        const Vec3& b = fine.positions[static_cast<std::size_t>(fine.triangles[t][(k + 1) % 3])];
        const Vec3 along = (given.way[1] - given.way[0]).normalized();
        const double off = (a - given.way[0]).cross(along).norm();
        nearest = std::min(nearest, off);
        if (off < 0.5) longest = std::max(longest, (a - b).norm());
      }
    }
    EXPECT_LT(nearest, 0.05) << "patch " << patch;
    EXPECT_LT(longest, 0.5) << "patch " << patch;
  }
}

TEST(FineSurface, its_points_are_carried_along_by_three_given_ones_at_most) {
  const Surfaces given;
  const FineSurface fine = given.refined();
  ASSERT_EQ(fine.points.size(), fine.positions.size());
  for (std::size_t p = 0; p < fine.points.size(); ++p) {
    Vec3 x = Vec3::Zero();
    double sum = 0.0;
    for (std::size_t k = 0; k < 3 && fine.points[p].node[k] >= 0; ++k) {
      ASSERT_GE(fine.points[p].weight[k], 0.0);
      x += fine.points[p].weight[k] * given.mesh.nodes[static_cast<std::size_t>(fine.points[p].node[k])];
      sum += fine.points[p].weight[k];
    }
    ASSERT_NEAR(sum, 1.0, 1e-12);
    ASSERT_LT((x - fine.positions[p]).norm(), 1e-9);
    if (p >= given.mesh.nodes.size()) continue;
    ASSERT_EQ(fine.points[p].node[0], static_cast<Index>(p));
  }
}

}  // namespace
}  // namespace stylet

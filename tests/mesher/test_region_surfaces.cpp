// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the surfaces of structures for pictures: each is closed, is the structure that was given, and overlaps no other
// organ.
#include "made_anatomy.hpp"
#include "stylet/mesher/mesher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace stylet {
namespace {

using testing::gland;
using testing::set_of;
using testing::tube;

MeshOptions coarse() {
  MeshOptions o;
  o.nodes = 1500;
  return o;
}

ContourSet pelvis() {
  return set_of({gland(), tube("Rectum", Vec3(5, 15, -25), 55, 12, 3), tube("Urethra", Vec3(5, -20, -14), 48, 3, 3),
                 testing::ellipsoid("Bladder", Vec3(5, -25, 45), Vec3(28, 25, 22), 3)});
}

/// All meshes of these tests: contours, and a mask of two zones.
const std::vector<MeshedAnatomy>& anatomies() {
  static const std::vector<MeshedAnatomy> made = [] {
    std::vector<MeshedAnatomy> all;
    all.push_back(*mesh_contours(pelvis(), coarse()));
    all.push_back(*mesh_labels(testing::two_zones(), coarse()));
    return all;
  }();
  return made;
}

const Vec3& corner(const Surface& s, const std::array<Index, 3>& t, int k) {
  return s.points[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
}

/// [mm³]
double volume(const Surface& s) {
  double sum = 0.0;
  for (const auto& t : s.triangles) sum += corner(s, t, 0).dot(corner(s, t, 1).cross(corner(s, t, 2))) / 6.0;
  return sum;
}

/// Whether a point is inside: by the solid angle under which it sees the surface (Van Oosterom & Strackee 1983).
bool contains(const Surface& s, const Vec3& p) {
  double angle = 0.0;
  for (const auto& t : s.triangles) {
    const Vec3 a = corner(s, t, 0) - p, b = corner(s, t, 1) - p, c = corner(s, t, 2) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle > 2.0 * std::numbers::pi;
}

const Surface& surface_of(const MeshedAnatomy& m, const std::string& region) {
  return m.mesh.surfaces.at(static_cast<std::size_t>(m.mesh.region_index(region)));
}

TEST(RegionSurfaces, each_region_has_one_that_is_closed_and_oriented_and_joins_in_edges_only) {
  for (const MeshedAnatomy& m : anatomies()) {
    ASSERT_EQ(m.mesh.surfaces.size(), m.mesh.regions.size());
    for (std::size_t r = 0; r < m.mesh.regions.size(); ++r) {
      const Surface& s = m.mesh.surfaces[r];
      EXPECT_EQ(s.name, m.mesh.regions[r]);
      EXPECT_FALSE(s.triangles.empty()) << s.name;
      std::map<std::pair<Index, Index>, int> edges;
      std::vector<int> around(s.points.size(), 0);
      for (const auto& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
          ++edges[{t[k], t[(k + 1) % 3]}];
          ++around[static_cast<std::size_t>(t[k])];
        }
      }
      for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1) << s.name;
        ASSERT_TRUE(edges.contains({edge.second, edge.first})) << s.name;
      }
      // A point of two sheets has more triangles around it than one fan of neighbours reaches.
      std::map<Index, std::map<Index, Index>> next;
      for (const auto& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) next[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3];
      }
      for (const auto& [point, fan] : next) {
        int reached = 1;
        for (Index at = fan.begin()->second; at != fan.begin()->first; at = fan.at(at)) ++reached;
        ASSERT_EQ(reached, around[static_cast<std::size_t>(point)]) << s.name;
      }
      EXPECT_GT(volume(s), 0.0) << s.name;
    }
  }
}

TEST(RegionSurfaces, of_organs_enclose_the_volumes_that_were_given) {
  const MeshedAnatomy& m = anatomies()[0];
  for (const RegionReport& region : m.report.regions) {
    if (region.structure_volume_cc == 0.0 || region.name == "body" || region.name == "band") continue;
    // The gland takes its share of the bladder; lumen and urethra lie inside rectum and gland and take nothing.
    const double given_cc = region.name == "bladder" ? region.input_volume_cc : region.structure_volume_cc;
    EXPECT_NEAR(volume(surface_of(m, region.name)) / 1000.0, given_cc, 0.03 * given_cc) << region.name;
  }
}

TEST(RegionSurfaces, do_not_depend_on_the_number_of_nodes) {
  MeshOptions finer = coarse();
  finer.nodes = 2500;
  const auto m = mesh_contours(pelvis(), finer);
  for (const char* organ : {"prostate", "urethra", "bladder", "rectum"}) {
    const Surface &a = surface_of(anatomies()[0], organ), &b = surface_of(*m, organ);
    EXPECT_EQ(a.points, b.points) << organ;
    EXPECT_EQ(a.triangles, b.triangles) << organ;
  }
}

/// [mm] Distance between a point and a triangle.
double distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - (p - a).dot(n) * n;
  const auto is_inside = [&](const Vec3& from, const Vec3& to) { return (to - from).cross(foot - from).dot(n) >= 0.0; };
  if (is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) return (foot - p).norm();
  const auto to_edge = [&](const Vec3& from, const Vec3& to) {
    const double share = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (from + share * (to - from) - p).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

TEST(RegionSurfaces, of_organs_overlap_by_less_than_half_a_millimetre_unless_one_lies_in_the_other) {
  const MeshedAnatomy& m = anatomies()[0];
  const auto pairs = {std::pair{"prostate", "bladder"}, std::pair{"prostate", "rectum"},
                      std::pair{"bladder", "rectum"}};
  for (const auto& [first, second] : pairs) {
    const Surface &a = surface_of(m, first), &b = surface_of(m, second);
    for (const auto& [inner, outer] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
      Eigen::AlignedBox3d box;
      for (const Vec3& q : outer->points) box.extend(q);
      for (const Vec3& p : inner->points) {
        if (!box.contains(p) || !contains(*outer, p)) continue;
        double nearest = HUGE_VAL;
        for (const auto& t : outer->triangles)
          nearest = std::min(nearest, distance(p, corner(*outer, t, 0), corner(*outer, t, 1), corner(*outer, t, 2)));
        ASSERT_LT(nearest, 0.5) << first << " and " << second;
      }
    }
  }
}

}  // namespace
}  // namespace stylet

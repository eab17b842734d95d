// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/locator.hpp"

#include "stylet/geom/box_mesh.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

// A mesh with its topology and locator, which keep references to each other.
struct Body {
  TetMesh mesh;
  Topology topology;
  Locator locator;
  explicit Body(TetMesh m) : mesh(std::move(m)), topology(mesh), locator(mesh, topology) {}
};

// A jittered box with a ball of a second region, so that the inner interface is rough.
TetMesh rough_ball() {
  TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {8, 8, 8}, 0.15);
  assign_regions(mesh, {"body", "ball"}, [](const Vec3& x) { return (x - Vec3(20, 20, 20)).norm() < 12.0 ? 1 : 0; });
  return mesh;
}

// A box of two regions that meet at x = 20.
TetMesh near_and_far() {
  TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {8, 8, 8});
  assign_regions(mesh, {"near", "far"}, [](const Vec3& x) { return x.x() < 20 ? 0 : 1; });
  return mesh;
}

// An L-shaped body: a box without its upper right quarter, so that straight paths leave and re-enter it.
TetMesh bracket() {
  TetMesh mesh = box_mesh({0, 0, 0}, {40, 20, 40}, {8, 4, 8});
  TetMesh out;
  out.regions = mesh.regions;
  std::vector<Index> number(mesh.nodes.size(), -1);
  for (const auto& tet : mesh.tets) {
    Vec3 centroid = Vec3::Zero();
    for (const Index a : tet) centroid += 0.25 * mesh.nodes[a];
    if (centroid.x() > 20 && centroid.z() > 20) continue;
    auto kept = tet;
    for (Index& a : kept) {
      if (number[a] < 0) {
        number[a] = out.node_count();
        out.nodes.push_back(mesh.nodes[a]);
      }
      a = number[a];
    }
    out.tets.push_back(kept);
    out.tet_region.push_back(0);
  }
  return out;
}

Vec3 place(const Body& body, const MaterialPoint& point) {
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 4; ++i) x += point.weights[i] * body.mesh.nodes[body.mesh.tets[point.tet][i]];
  return x;
}

class Random {
 public:
  double uniform(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine_()) / 4294967296.0); }
  Vec3 point(double lo, double hi) { return {uniform(lo, hi), uniform(lo, hi), uniform(lo, hi)}; }
  Index below(Index n) { return static_cast<Index>(engine_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 engine_{7};
};

// Parameter at which the segment meets the triangle (Möller and Trumbore's formula); negative when it does not.
double meet(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 d = to - from;
  const Vec3 p = d.cross(c - a);
  const double det = p.dot(b - a);
  if (det == 0.0) return -1.0;
  const Vec3 s = from - a;
  const double u = p.dot(s) / det;
  const Vec3 q = s.cross(b - a);
  const double v = q.dot(d) / det;
  const double t = q.dot(c - a) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 && t <= 1.0 ? t : -1.0;
}

TEST(Locator, finds_random_points_with_and_without_hint) {
  const Body body(rough_ball());
  Random random;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 x = random.point(0.0, 40.0);
    const auto found = body.locator.find(x, i % 2 == 0 ? -1 : random.below(body.mesh.tet_count()));
    ASSERT_TRUE(found);
    EXPECT_GE(found->weights.minCoeff(), -1e-12);
    EXPECT_NEAR(found->weights.sum(), 1.0, 1e-12);
    EXPECT_LT((place(body, *found) - x).norm(), 1e-10);
  }
}

TEST(Locator, finds_nodes_edges_and_faces_of_all_elements) {
  const Body body(rough_ball());
  Random random;
  for (Index t = 0; t < body.mesh.tet_count(); ++t) {
    const auto& tet = body.mesh.tets[t];
    for (int zeros = 1; zeros <= 3; ++zeros) {
      Vec4 w(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
      for (int i = 0; i < zeros; ++i) w[(t + i) % 4] = 0.0;
      w /= w.sum();
      const Vec3 x = place(body, {t, w});
      const Vec3 travel = random.point(-1.0, 1.0);
      for (const Index hint : {Index{-1}, t, random.below(body.mesh.tet_count())}) {
        const auto found = body.locator.find(x, hint, hint < 0 ? Vec3::Zero() : travel);
        ASSERT_TRUE(found) << "tet " << t << " zeros " << zeros;
        EXPECT_GE(found->weights.minCoeff(), -1e-12);
        EXPECT_LT((place(body, *found) - x).norm(), 1e-8);
      }
    }
    ASSERT_TRUE(body.locator.find(body.mesh.nodes[tet[t % 4]]));
  }
}

TEST(Locator, finds_nothing_outside_a_concave_mesh_and_everything_inside) {
  const Body body(bracket());
  ASSERT_TRUE(check_mesh(body.mesh, "bracket"));
  Random random;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 x(random.uniform(-5, 45), random.uniform(-5, 25), random.uniform(-5, 45));
    const bool in_box = x.x() >= 0 && x.x() <= 40 && x.y() >= 0 && x.y() <= 20 && x.z() >= 0 && x.z() <= 40;
    const bool expected = in_box && !(x.x() > 20 && x.z() > 20);
    EXPECT_EQ(body.locator.find(x, random.below(body.mesh.tet_count())).has_value(), expected) << x.transpose();
  }
  EXPECT_FALSE(body.locator.find(Vec3::Constant(std::nan(""))));
}

TEST(Locator, ties_are_broken_by_the_direction_of_travel) {
  const Body body(near_and_far());
  Random random;
  for (int i = 0; i < 3000; ++i) {
    // A point on the interface: on a face, on an edge of the grid, or on a node.
    Vec3 x(20.0, random.uniform(1, 39), random.uniform(1, 39));
    if (i % 3 > 0) x.y() = 5.0 * (1 + random.below(7));
    if (i % 3 > 1) x.z() = 5.0 * (1 + random.below(7));
    Vec3 travel = random.point(-1.0, 1.0);
    if (std::abs(travel.x()) < 1e-3) continue;
    const auto found = body.locator.find(x, random.below(body.mesh.tet_count()), travel);
    ASSERT_TRUE(found);
    EXPECT_EQ(body.mesh.tet_region[found->tet], travel.x() > 0 ? 1 : 0);
    // The element contains x + 0·travel.
    EXPECT_GE(body.locator.weights(found->tet, x + 1e-6 * travel).minCoeff(), -1e-12);
  }
}

TEST(Locator, first_crossing_agrees_with_brute_force) {
  const Body body(rough_ball());
  Random random;
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 from = random.point(0.5, 39.5);
    const Vec3 to = random.point(-15.0, 55.0);
    const Index start = body.locator.find(from)->tet;
    double expected = 2.0;
    for (const auto* faces : {&body.topology.boundary, &body.topology.interfaces}) {
      for (const Face& face : *faces) {
        const double t = meet(from, to, body.mesh.nodes[face.nodes[0]], body.mesh.nodes[face.nodes[1]],
                              body.mesh.nodes[face.nodes[2]]);
        if (t >= 0.0) expected = std::min(expected, t);
      }
    }
    MaterialPoint end;
    const auto crossing = body.locator.first_crossing(from, start, to, end);
    ASSERT_EQ(crossing.has_value(), expected <= 1.0) << i;
    if (crossing) {
      ++met;
      EXPECT_NEAR(crossing->t, expected, 1e-10);
      const int region = body.mesh.tet_region[start];
      const Index other = body.topology.neighbour[crossing->tet][crossing->local];
      EXPECT_EQ(body.mesh.tet_region[crossing->tet], region);
      EXPECT_TRUE(other < 0 || body.mesh.tet_region[other] != region);
      EXPECT_NEAR(body.locator.weights(crossing->tet, from + crossing->t * (to - from))[crossing->local], 0.0, 1e-10);
    } else {
      EXPECT_LT((place(body, end) - to).norm(), 1e-10);
      EXPECT_GE(end.weights.minCoeff(), -1e-12);
    }
  }
  EXPECT_GT(met, 2400);
}

TEST(Locator, paths_through_edges_and_nodes_stop_where_the_region_changes) {
  // Without jitter, paths between grid nodes run along edges, through nodes and inside faces all the way.
  const Body body(near_and_far());
  Random random;
  for (int i = 0; i < 5000; ++i) {
    const auto grid = [&](int lo, int hi) { return 5.0 * (lo + random.below(hi - lo + 1)); };
    const Vec3 from(grid(0, 3), grid(1, 7), grid(1, 7));
    const Vec3 to(grid(0, 8), grid(1, 7), grid(1, 7));
    if (from == to) continue;
    const Index start = body.locator.find(from, -1, to - from)->tet;
    ASSERT_EQ(body.mesh.tet_region[start], 0);
    MaterialPoint end;
    const auto crossing = body.locator.first_crossing(from, start, to, end);
    ASSERT_EQ(crossing.has_value(), to.x() > 20.0) << from.transpose() << " to " << to.transpose();
    if (crossing) {
      EXPECT_NEAR(crossing->t, (20.0 - from.x()) / (to.x() - from.x()), 1e-12);
      const Index other = body.topology.neighbour[crossing->tet][crossing->local];
      ASSERT_GE(other, 0);
      EXPECT_EQ(body.mesh.tet_region[other], 1);
    } else {
      EXPECT_LT((place(body, end) - to).norm(), 1e-10);
    }
    // The same for a path out of the mesh, to a mirror image of `to` beyond x = 40 or x = 0.
    const Vec3 out(to.x() > from.x() ? 60.0 : -20.0, to.y(), to.z());
    const Index begin = body.locator.find(from, -1, out - from).value().tet;
    const auto leaving = body.locator.first_crossing(from, begin, out, end);
    ASSERT_TRUE(leaving);
    EXPECT_NEAR(leaving->t, ((out.x() > 0 ? 20.0 : 0.0) - from.x()) / (out.x() - from.x()), 1e-12);
  }
}

TEST(Locator, a_path_that_starts_on_an_interface_follows_its_direction) {
  const Body body(near_and_far());
  const Vec3 from(20, 12, 13);
  const Vec3 ahead(33, 14, 17);
  const Vec3 back(3, 14, 17);
  MaterialPoint end;
  const Index far = body.locator.find(from, -1, ahead - from)->tet;
  EXPECT_FALSE(body.locator.first_crossing(from, far, ahead, end));
  EXPECT_LT((place(body, end) - ahead).norm(), 1e-10);
  const Index near = body.locator.find(from, -1, back - from)->tet;
  EXPECT_FALSE(body.locator.first_crossing(from, near, back, end));
  // From the near side into the far one, the crossing is at the start.
  const auto crossing = body.locator.first_crossing(from, near, ahead, end);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->t, 0.0, 1e-12);
  EXPECT_EQ(body.mesh.tet_region[crossing->tet], 0);
}

// Follows a path through all regions as a needle would, checks each piece, and returns the number of pieces.
int follow(const Body& body, const Vec3& from, const Vec3& to) {
  const Vec3 d = to - from;
  const auto entry = body.locator.first_entry(from, to);
  if (!entry) return 0;
  double t = entry->t;
  Index tet = body.locator.find(from + t * d, entry->tet, d).value().tet;
  int pieces = 0;
  while (true) {
    ++pieces;
    if (pieces > 10000) {
      ADD_FAILURE() << "no end in sight from " << from.transpose() << " to " << to.transpose();
      return pieces;
    }
    const int region = body.mesh.tet_region[tet];
    const Vec3 start = from + t * d;
    MaterialPoint end;
    const auto crossing = body.locator.first_crossing(start, tet, to, end);
    const double next = crossing ? t + crossing->t * (1.0 - t) : 1.0;
    // At every place between two crossings, the path is in a tetrahedron of the region.
    for (const double share : {0.1, 0.5, 0.77}) {
      const Vec3 x = from + (t + share * (next - t)) * d;
      bool seen = false;
      const auto found = body.locator.find(x, tet);
      EXPECT_TRUE(found);
      for (int i = 0; found && i < 4 && !seen; ++i) {
        for (const Index c : body.topology.node_tets[body.mesh.tets[found->tet][i]]) {
          seen = seen || (body.mesh.tet_region[c] == region && body.locator.weights(c, x).minCoeff() > -1e-8);
        }
      }
      EXPECT_TRUE(seen) << "piece " << pieces << " from " << from.transpose() << " to " << to.transpose();
    }
    if (!crossing) {
      EXPECT_EQ(body.mesh.tet_region[end.tet], region);
      EXPECT_LT((place(body, end) - to).norm(), 1e-8);
      return pieces;
    }
    const Index other = body.topology.neighbour[crossing->tet][crossing->local];
    // Where the path leaves the mesh through an edge, the outer face may belong to another region at that edge.
    EXPECT_TRUE(other < 0 || body.mesh.tet_region[crossing->tet] == region);
    t = next;
    const auto ahead = body.locator.find(from + t * d, other, d);
    EXPECT_TRUE(ahead);
    if (!ahead) return pieces;
    if (other < 0) {
      // After leaving a convex mesh, the path does not enter it again.
      EXPECT_FALSE(body.locator.find(from + std::min(1.0, t + 1e-6) * d));
      return pieces;
    }
    EXPECT_NE(body.mesh.tet_region[ahead->tet], region);
    tet = ahead->tet;
  }
}

TEST(Locator, paths_through_a_mosaic_of_regions_are_followed_piece_by_piece) {
  // Every tetrahedron gets one of three regions at random: faces, edges and nodes are all interfaces.
  Random random;
  const auto mosaic = [&random](double jitter) {
    TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {8, 8, 8}, jitter);
    assign_regions(mesh, {"a", "b", "c"}, [&](const Vec3&) { return static_cast<int>(random.below(3)); });
    return mesh;
  };
  const Body rough(mosaic(0.15));
  const Body regular(mosaic(0.0));
  int pieces = 0;
  for (int i = 0; i < 1000; ++i) pieces += follow(rough, random.point(-30, 70), random.point(-5, 45));
  EXPECT_GT(pieces, 5000);
  // Between grid points, paths run along edges, in faces and through nodes.
  pieces = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto grid = [&](int lo, int hi) { return 5.0 * (lo + random.below(hi - lo + 1)); };
    pieces += follow(regular, {grid(0, 8), grid(-3, 11), grid(9, 12)}, {grid(1, 7), grid(1, 7), grid(-3, 8)});
  }
  EXPECT_GT(pieces, 5000);
}

TEST(Locator, first_entry_agrees_with_brute_force_on_a_concave_body) {
  const Body body(bracket());
  Random random;
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 from(random.uniform(-30, 70), random.uniform(-30, 50), random.uniform(-30, 70));
    if (body.locator.find(from)) continue;
    const Vec3 to(random.uniform(-10, 50), random.uniform(-10, 30), random.uniform(-10, 50));
    double expected = 2.0;
    for (const Face& face : body.topology.boundary) {
      if (body.locator.face_normal(face.tet, face.local).dot(to - from) >= 0.0) continue;
      const double t = meet(from, to, body.mesh.nodes[face.nodes[0]], body.mesh.nodes[face.nodes[1]],
                            body.mesh.nodes[face.nodes[2]]);
      if (t >= 0.0) expected = std::min(expected, t);
    }
    const auto entry = body.locator.first_entry(from, to);
    ASSERT_EQ(entry.has_value(), expected <= 1.0) << i;
    if (!entry) continue;
    ++met;
    EXPECT_NEAR(entry->t, expected, 1e-10);
    EXPECT_LT(body.topology.neighbour[entry->tet][entry->local], 0);
  }
  EXPECT_GT(met, 900);
}

TEST(Locator, entry_through_edges_and_nodes_of_the_skin_is_not_missed) {
  const Body body(box_mesh({0, 0, 0}, {40, 40, 40}, {8, 8, 8}));
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      const Vec3 target(5.0 * i, 5.0 * j, 0.0);
      const Vec3 inward = Vec3(20, 20, 20) - target;
      const auto entry = body.locator.first_entry(target - inward, target + 0.5 * inward);
      ASSERT_TRUE(entry) << i << ' ' << j;
      EXPECT_NEAR(entry->t, 2.0 / 3.0, 1e-12);
      // From the skin itself inwards the entry is at the start; outwards there is none.
      const auto touching = body.locator.first_entry(target, target + inward);
      ASSERT_TRUE(touching);
      EXPECT_NEAR(touching->t, 0.0, 1e-12);
      EXPECT_FALSE(body.locator.first_entry(target, target - inward));
    }
  }
}

TEST(Locator, a_path_that_only_touches_an_edge_does_not_enter) {
  const Body body(box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4}));
  EXPECT_FALSE(body.locator.first_entry({-10, 20, 10}, {10, 20, -10}));  // the path only touches the edge x = z = 0
  EXPECT_FALSE(body.locator.first_entry({-10, -10, 20}, {-10, 50, 20}));
  EXPECT_TRUE(body.locator.first_entry({-10, 20, 10.001}, {10, 20, -9.999}));
}

}  // namespace
}  // namespace stylet

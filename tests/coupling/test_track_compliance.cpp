// SPDX-License-Identifier: GPL-3.0-or-later
// Node addition against a new factorisation of the split mesh.
#include "stylet/coupling/track_compliance.hpp"

#include "two_region_block.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

using namespace stylet;
using stylet::test::Block;

namespace {

/// Largest difference between the compliances among the added nodes and those of a new factorisation of the split mesh,
/// over the largest entry.
double difference_to_refactorised(const Block& block, const TrackCompliance& track) {
  const TetMesh split = track.mesh().materialise();
  EXPECT_TRUE(check_mesh(split, "split mesh").ok());
  auto fresh = Tissue::build(split, block.materials, block.fixed);
  EXPECT_TRUE(fresh.ok());
  const Index base = block.tissue->mesh().node_count();
  const Index added = split.node_count() - base;
  MatX load = MatX::Zero(3 * split.node_count(), 3 * added);
  for (Index k = 0; k < added; ++k) load.block<3, 3>(3 * (base + k), 3 * k) = Mat3::Identity();
  const MatX reference = fresh->solve(load).bottomRows(3 * added);
  const MatX ours = track.matrix().block(3, 3, 3 * added, 3 * added);
  return (ours - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

/// A straight line through the block, from face to face of its elements.
class LineThroughFaces {
 public:
  explicit LineThroughFaces(const Block& block) : block_(block), tet_(block.locator->find(x_, -1, direction_)->tet) {
    leave();
  }
  [[nodiscard]] const Vec3& x() const { return x_; }  ///< on a face of at().tet
  [[nodiscard]] MaterialPoint at() const { return {tet_, block_.locator->weights(tet_, x_)}; }
  [[nodiscard]] const Vec3& direction() const { return direction_; }

  /// Moves through the next element. @return false where there is none
  bool next() {
    const Index beyond = block_.topology->neighbour[static_cast<std::size_t>(tet_)][static_cast<std::size_t>(local_)];
    if (beyond < 0) return false;
    tet_ = beyond;
    return leave();
  }

 private:
  bool leave() {
    const Vec4 here = block_.locator->weights(tet_, x_);
    const Vec4 there = block_.locator->weights(tet_, x_ + 40.0 * direction_);
    double first = 2.0;
    for (int i = 0; i < 4; ++i) {
      if (there[i] < -1e-9 && here[i] / (here[i] - there[i]) < first && here[i] > 1e-9) {
        first = here[i] / (here[i] - there[i]);
        local_ = i;
      }
    }
    EXPECT_LT(first, 2.0) << "no way out of element " << tet_;
    x_ += first * 40.0 * direction_;
    return first < 2.0;
  }

  const Block& block_;
  Vec3 direction_ = Vec3(0.13, 0.08, 1.0).normalized();
  Vec3 x_{17.3, 18.1, 0.0};
  Index tet_;
  int local_ = 0;
};

}  // namespace

TEST(NodeAddition, hundred_interior_nodes_by_the_shortcut_equal_a_refactorised_mesh) {
  const Block block;
  TrackCompliance track(block.store, *block.locator, 100);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(2.0, 38.0);
  int added = 0;
  // Half of the nodes are in one corner, so that many are in elements that are split already.
  while (added < 100) {
    const double shrink = added % 2 ? 1.0 : 0.25;
    const Vec3 x = shrink * Vec3(place(random), place(random), place(random)) + Vec3::Constant(1.0);
    const auto at = block.locator->find(x);
    ASSERT_TRUE(at.has_value());
    if (track.add(*at, x, Placement::interior).point >= 0) ++added;
  }
  EXPECT_GT(track.mesh().materialise().tet_count(), block.tissue->mesh().tet_count() + 299);
  EXPECT_LT(difference_to_refactorised(block, track), 1e-8);
}

TEST(NodeAddition, hundred_face_nodes_by_the_bordered_update_equal_a_refactorised_mesh) {
  const Block block;
  TrackCompliance track(block.store, *block.locator, 100);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> weight(0.1, 1.0);
  std::uniform_int_distribution<Index> pick(0, block.tissue->mesh().tet_count() - 1);
  int added = 0;
  int on_surface = 0;
  while (added < 100) {
    const Index tet = pick(random);
    const int local = static_cast<int>(random() % 4);
    Vec4 w(weight(random), weight(random), weight(random), weight(random));
    w[local] = 0.0;
    w /= w.sum();
    Vec3 x = Vec3::Zero();
    for (int i = 0; i < 4; ++i) {
      x += w[i] * block.tissue->mesh().nodes[static_cast<std::size_t>(
                      block.tissue->mesh().tets[static_cast<std::size_t>(tet)][static_cast<std::size_t>(i)])];
    }
    const Vec3 out = block.locator->face_normal(tet, local);
    if (track.add({tet, w}, x, Placement::face, out).point < 0) continue;
    ++added;
    on_surface += block.topology->neighbour[static_cast<std::size_t>(tet)][static_cast<std::size_t>(local)] < 0 ? 1 : 0;
  }
  EXPECT_GT(on_surface, 5);
  EXPECT_LT(difference_to_refactorised(block, track), 1e-8);
}

TEST(NodeAddition, a_needle_track_of_face_nodes_equals_a_refactorised_mesh) {
  const Block block(6);
  TrackCompliance track(block.store, *block.locator, 60);
  LineThroughFaces line(block);
  int added = 0;
  do {
    if (track.add(line.at(), line.x(), Placement::face, line.direction()).point >= 0) ++added;
  } while (line.next());
  EXPECT_GE(added, 8);
  EXPECT_LT(difference_to_refactorised(block, track), 1e-8);
}

/// Adds nodes and interpolated points along the line while the tip moves among them.
/// @param placements placements of the nodes, in turn
/// @return largest difference from a new factorisation of the split mesh, over the largest entry
double difference_along_a_line(const Block& block, TrackCompliance& track, const std::vector<Placement>& placements) {
  LineThroughFaces line(block);
  std::vector<MaterialPoint> place(1);  // places of the tip and the points
  std::vector<Index> node(1, -1);       // each point's own node; −1: none
  int nodes = 0;
  const auto lay = [&](const MaterialPoint& at, const Vec3& x, Placement placement) {
    if (track.add(at, x, placement, line.direction()).point < 0) return;
    place.push_back(at);
    node.push_back(placement == Placement::embedded ? -1 : block.tissue->mesh().node_count() + nodes++);
  };
  const auto put_tip = [&](const Vec3& x) {
    const auto at = block.locator->find(x, line.at().tet);
    if (!at) return;
    EXPECT_TRUE(track.move_tip(*at, x));
    place.front() = *at;
  };
  std::size_t face = 0;
  do {
    // The tip is before the face, at it, or beyond it when the node is added.
    put_tip(line.x() + (static_cast<double>(face % 3) - 1.0) * 1.3 * line.direction());
    const Index tet = line.at().tet;
    const auto inside = [&](const Vec4& weights) {
      Vec3 x = Vec3::Zero();
      for (int i = 0; i < 4; ++i)
        x += weights[i] * block.tissue->node_position(
                              block.tissue->mesh().tets[static_cast<std::size_t>(tet)][static_cast<std::size_t>(i)]);
      return x;
    };
    const Placement placement = placements[face % placements.size()];
    const Vec4 middle(0.3, 0.3, 0.2, 0.2);
    if (placement == Placement::face) lay(line.at(), line.x(), placement);
    if (placement == Placement::interior) lay({tet, middle}, inside(middle), placement);
    put_tip(line.x() - 0.4 * line.direction());
    const Vec4 weights(0.4, 0.3, 0.2, 0.1);
    if (face % 2 == 0) lay({tet, weights}, inside(weights), Placement::embedded);
    if (face % 4 == 1) {
      EXPECT_GE(track.add({tet, weights}, inside(weights), Placement::embedded).point, 0);
      track.remove_last_embedded();
    }
    ++face;
  } while (line.next());
  EXPECT_GE(nodes, 8);
  EXPECT_GE(track.points(), nodes + 5);

  const TetMesh split = track.mesh().materialise();
  const auto fresh = Tissue::build(split, block.materials, block.fixed);
  EXPECT_TRUE(fresh.ok());
  MatX load = MatX::Zero(3 * split.node_count(), 3 * track.points());
  for (int c = 0; c < track.points(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    if (node[k] >= 0) {
      load.block<3, 3>(3 * node[k], 3 * c) = Mat3::Identity();
      continue;
    }
    const Shape shape = block.tissue->shape(place[k].tet, place[k].weights);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      load.block<3, 3>(3 * shape.node[i], 3 * c) = shape.weight[i] * Mat3::Identity();
  }
  const MatX reference = load.transpose() * fresh->solve(load);
  const MatX ours = track.matrix().topLeftCorner(reference.rows(), reference.cols());
  EXPECT_EQ((ours - ours.transpose()).cwiseAbs().maxCoeff(), 0.0);
  return (ours - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

// Values at the nodes of the tip's element and at the vertices of split elements are copied from each other, kept from
// element to element, and changed by every node. Nothing of them may remain after reset().
TEST(NodeAddition, tracks_with_their_tip_and_interpolated_points_among_nodes_equal_refactorised_meshes) {
  const Block block(6);
  TrackCompliance track(block.store, *block.locator, 60);
  const std::vector<std::vector<Placement>> kinds{{Placement::face},
                                                  {Placement::interior},
                                                  {Placement::face, Placement::interior},
                                                  {Placement::interior, Placement::interior, Placement::face}};
  for (int round = 0; round < 2; ++round) {
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      track.reset();
      EXPECT_LT(difference_along_a_line(block, track, kinds[kind]), 1e-8) << "kind " << kind << ", round " << round;
    }
  }
}

TEST(NodeAddition, interior_nodes_leave_old_compliances_bit_for_bit_unchanged) {
  const Block block;
  TrackCompliance track(block.store, *block.locator, 20);
  const Vec3 a(11.1, 12.3, 14.2);
  const Vec3 b(22.0, 21.0, 19.5);
  const auto place = [&](const Vec3& x, Placement placement) {
    return track.add(*block.locator->find(x), x, placement).point;
  };
  ASSERT_EQ(place(a, Placement::embedded), 1);
  ASSERT_EQ(place(b, Placement::embedded), 2);
  const Mat3 before = track(1, 2);
  int added = 0;
  for (int i = 0; i < 20 && added < 5; ++i)
    added += place(a + 0.37 * i * Vec3(1, 0.6, 0.9), Placement::interior) >= 0 ? 1 : 0;
  ASSERT_GE(added, 3);
  EXPECT_EQ((track(1, 2) - before).norm(), 0.0);
}

TEST(NodeAddition, contacts_denser_than_elements_stay_regular_as_nodes_and_follow_from_each_other_embedded) {
  const Block block(2);  // elements of 20 mm, contacts 2 mm apart
  for (const Placement placement : {Placement::interior, Placement::embedded}) {
    TrackCompliance track(block.store, *block.locator, 20);
    std::vector<int> points;
    double smallest = 1.0;
    for (int i = 0; i < 12; ++i) {
      const Vec3 x(13.0, 11.0, 4.0 + 2.0 * i);
      const auto added = track.add(*block.locator->find(x), x, placement);
      if (added.point < 0) continue;
      if (!points.empty()) smallest = std::min(smallest, track.independence(added.point, points));
      if (points.size() < TrackCompliance::kNeighbours) points.push_back(added.point);
    }
    if (placement == Placement::interior) {
      EXPECT_GT(smallest, 0.05);
    } else {
      EXPECT_LT(smallest, 1e-6);
    }
  }
}

TEST(NodeAddition, reset_restores_the_first_state_exactly) {
  const Block block;
  TrackCompliance track(block.store, *block.locator, 10);
  const Vec3 x(13.0, 11.0, 9.0);
  const auto at = *block.locator->find(x);
  ASSERT_TRUE(track.move_tip(at, x));
  const MatX before = track.matrix();
  for (int i = 0; i < 200 && track.points() < 6; ++i) {
    const Vec3 y = x + Vec3(0.13 * (i % 17), 0.21 * (i % 13), 0.1 * i);
    track.add(*block.locator->find(y), y, Placement::interior);
  }
  ASSERT_EQ(track.points(), 6);
  track.reset();
  EXPECT_EQ(track.points(), 1);
  EXPECT_EQ(track.mesh().materialise().tet_count(), block.tissue->mesh().tet_count());
  ASSERT_TRUE(track.move_tip(at, x));
  EXPECT_EQ((track.matrix() - before).cwiseAbs().maxCoeff(), 0.0);
}

TEST(NodeAddition, nodal_load_of_contact_forces_gives_the_displacement_of_the_refactorised_mesh) {
  const Block block;
  for (const Placement placement : {Placement::interior, Placement::face}) {
    TrackCompliance track(block.store, *block.locator, 10);
    const Vec3 direction(0, 0, 1);
    Vec3 x(17.3, 18.1, 6.0);
    for (int i = 0; i < 60 && track.points() < 4; ++i) {
      x = Vec3(17.3 + 0.2 * i, 18.1 + 0.1 * i, 6.0 + 0.45 * i);
      auto at = *block.locator->find(x);
      if (placement == Placement::face) {  // moved to the nearest face along z
        const Vec4 here = at.weights;
        const Vec4 there = block.locator->weights(at.tet, x + 40.0 * direction);
        double first = 2.0;
        for (int k = 0; k < 4; ++k) {
          if (there[k] < 0.0) first = std::min(first, here[k] / (here[k] - there[k]));
        }
        x += first * 40.0 * direction;
        at.weights = block.locator->weights(at.tet, x);
      }
      track.add(at, x, placement, direction);
    }
    ASSERT_GE(track.points(), 3);
    MatX forces = MatX::Zero(3, track.points());
    for (int c = 1; c < track.points(); ++c) forces.col(c) = Vec3(0.1 * c, -0.05, 0.2);
    const VecX u = block.tissue->solve(track.base_load(forces));

    const TetMesh split = track.mesh().materialise();
    auto fresh = Tissue::build(split, block.materials, block.fixed);
    ASSERT_TRUE(fresh.ok());
    const Index base = block.tissue->mesh().node_count();
    VecX load = VecX::Zero(3 * split.node_count());
    for (int c = 1; c < track.points(); ++c) load.segment<3>(3 * (base + c - 1)) = forces.col(c);
    const VecX reference = fresh->solve(load).topRows(3 * base);
    EXPECT_LT((u - reference).cwiseAbs().maxCoeff(), 1e-9 * reference.cwiseAbs().maxCoeff());
  }
}

TEST(NodeAddition, refuses_what_it_cannot_do_and_says_why) {
  using Refusal = TrackCompliance::Refusal;
  const Block block;
  const TetMesh& mesh = block.tissue->mesh();
  const Index tet = block.locator->find(Vec3(13.0, 11.0, 9.0))->tet;
  const auto add = [&](TrackCompliance& track, const Vec4& weights, Placement placement) {
    Vec3 x = Vec3::Zero();
    for (int v = 0; v < 4; ++v)
      x += weights[v] * mesh.nodes[static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(tet)][v])];
    const Vec3 outwards = block.locator->face_normal(tet, 3);
    return track.add({tet, weights}, x, placement, outwards).refusal;
  };
  const Vec4 inside = Vec4::Constant(0.25);
  const Vec4 on_face(0.3, 0.3, 0.4, 0.0);
  const Vec4 near_edge(0.49, 0.5, 0.01, 0.0);

  TrackCompliance without(std::make_shared<const ComplianceStore>(block.tissue), *block.locator, 4);
  EXPECT_EQ(add(without, inside, Placement::embedded), Refusal::missing);
  EXPECT_EQ(add(without, inside, Placement::interior), Refusal::missing);
  EXPECT_EQ(add(without, on_face, Placement::face), Refusal::missing);
  EXPECT_FALSE(without.move_tip({tet, inside}, Vec3::Zero()));

  // A place that cannot be split is refused for its geometry, whether its compliance is missing or not.
  TrackCompliance track(block.store, *block.locator, 3);
  for (TrackCompliance* either : {&without, &track}) {
    EXPECT_EQ(add(*either, on_face, Placement::interior), Refusal::geometry);
    EXPECT_EQ(add(*either, near_edge, Placement::face), Refusal::geometry);
    EXPECT_EQ(add(*either, inside, Placement::face), Refusal::geometry);
  }
  EXPECT_EQ(add(track, inside, Placement::interior), Refusal::none);
  EXPECT_EQ(add(track, on_face, Placement::face), Refusal::none);
  EXPECT_EQ(add(track, near_edge, Placement::embedded), Refusal::none);
  EXPECT_EQ(add(track, inside, Placement::embedded), Refusal::capacity);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Displacements of a track's observables by loads, against the store's compliance.
#include "coupling/track/track_observables.hpp"

#include "coupling/two_region_block.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using stylet::test::Block;

namespace {

constexpr double kRounding = 1e-13;

/// Two points inside elements of the block and one of its nodes.
struct ThreeObservables : testing::Test {
  const Block block{2};
  const std::array<Shape, 3> shapes{block.tissue->shape(3, Vec4(0.1, 0.2, 0.3, 0.4)),
                                    block.tissue->shape(3, Vec4(0.5, 0.0, 0.2, 0.3)),
                                    block.tissue->shape(7, Vec4(0.25, 0.25, 0.25, 0.25))};
  TrackObservables observables{block.store, 8, 4};
  std::vector<int> number;

  ThreeObservables() {
    for (const Shape& shape : shapes) number.push_back(observables.add(shape));
  }

  [[nodiscard]] Mat3 expected(const Shape& at, std::span<const Index> nodes, std::span<const Mat3> forces) const {
    Mat3 sum = Mat3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(at.count); ++i) {
      for (std::size_t k = 0; k < nodes.size(); ++k)
        sum += at.weight[i] * block.store->block(at.node[i], nodes[k]) * forces[k];
    }
    return sum;
  }
  [[nodiscard]] Mat3 expected(const Shape& at, const Shape& on) const {
    std::array<Mat3, kMostElementNodes> forces{};
    for (std::size_t i = 0; i < forces.size(); ++i) forces[i] = on.weight[i] * Mat3::Identity();
    const auto count = static_cast<std::size_t>(on.count);
    return expected(at, std::span(on.node).first(count), std::span(forces).first(count));
  }
};

void expect_near(const Mat3& a, const Mat3& b) { EXPECT_LE((a - b).norm(), kRounding * (1.0 + b.norm())); }

}  // namespace

TEST_F(ThreeObservables, are_numbered_after_the_tip_and_its_nodes) {
  EXPECT_EQ(number, (std::vector<int>{TrackObservables::kFirstFree, TrackObservables::kFirstFree + 1,
                                      TrackObservables::kFirstFree + 2}));
}

TEST_F(ThreeObservables, have_the_compliance_that_the_store_gives_between_their_nodes) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b)
      expect_near(observables.compliance(number[a], number[b]), expected(shapes[a], shapes[b]));
  }
}

TEST_F(ThreeObservables, are_moved_by_a_force_on_one_of_them_or_on_the_tip) {
  observables.set(TrackObservables::kTip, shapes[2]);
  for (std::size_t a = 0; a < 3; ++a) {
    observables.load(number[1]);
    expect_near(observables.at(number[a]), expected(shapes[a], shapes[1]));
    observables.load(TrackObservables::kTip);
    expect_near(observables.at(number[a]), expected(shapes[a], shapes[2]));
  }
}

TEST_F(ThreeObservables, are_moved_by_forces_on_nodes_whether_found_for_all_of_them_or_for_one) {
  const std::array<Index, 3> nodes{0, 5, 11};
  const std::array<Mat3, 3> forces{Mat3::Identity(), 2.0 * Mat3::Ones(), Vec3(1, -2, 3).asDiagonal().toDenseMatrix()};
  observables.load(NodeLoads{nodes, forces});
  for (std::size_t a = 0; a < 3; ++a) {
    const Mat3 right = expected(shapes[a], nodes, forces);
    expect_near(observables.at(number[a]), right);
    expect_near(observables.moved_by({nodes, forces}, number[a]), right);
  }
}

TEST_F(ThreeObservables, are_found_as_vertices_only_where_they_were_added_as_such) {
  const Index node = shapes[0].node[0];
  EXPECT_EQ(observables.find(node), -1);
  const int vertex = observables.add({.count = 1, .node = {node}, .weight = {1.0}}, node);
  EXPECT_EQ(observables.find(node), vertex);
  observables.remove_last();
  EXPECT_EQ(observables.find(node), -1);
}

TEST_F(ThreeObservables, keep_their_nodes_when_one_that_came_later_is_removed) {
  observables.remove_last();
  EXPECT_EQ(observables.count(), TrackObservables::kFirstFree + 2);
  EXPECT_EQ(observables.add(shapes[1]), number[2]) << "in its place";
  observables.load(number[0]);
  for (const int o : number)
    expect_near(observables.at(o), expected(o == number[0] ? shapes[0] : shapes[1], shapes[0]));
}

TEST_F(ThreeObservables, mark_the_nodes_of_their_shapes_and_of_the_tip_s) {
  observables.reset();
  observables.set(TrackObservables::kTip, shapes[2]);
  observables.add(shapes[0]);
  std::vector<unsigned> stamps(static_cast<std::size_t>(block.tissue->displacement_nodes()), 0);
  observables.mark_nodes(stamps, 9);
  for (Index node = 0; node < block.tissue->displacement_nodes(); ++node) {
    const auto has = [&](const Shape& shape) {
      const auto nodes = std::span(shape.node).first(static_cast<std::size_t>(shape.count));
      return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
    };
    EXPECT_EQ(stamps[static_cast<std::size_t>(node)], has(shapes[0]) || has(shapes[2]) ? 9u : 0u) << node;
  }
}

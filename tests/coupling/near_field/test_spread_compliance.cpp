// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/near_field/medium_block.hpp"
#include "evidence/validate/bonded_cylinder.hpp"
#include "support/sanitized.hpp"

#include <Eigen/Eigenvalues>

#include <random>
#include <tuple>

namespace stylet {
namespace {

using test::MediumBlock;
using test::NeedleLine;

/// From below the middle of the block to above it.
const NeedleWay kThrough{{1.3, 0.7, -48.0}, Vec3::UnitZ(), 96.0};

/// F along a way in an unbounded medium: the block's held faces move with the field of the same force.
Mat3 unbounded(const MediumBlock& block, const Vec3& x, const Vec3& on) {
  std::vector<Mat3> field;
  for (const Index node : block.fixed)
    field.push_back(kelvinlet(block.tissue->node_position(node) - on, SpreadCompliance::kSpread_mm, block.medium));
  return (*block.spread)(block.spread->place(x), block.spread->place(on)) + block.lift(x, field);
}

class SpreadForces : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(SpreadForces, move_an_unbounded_medium_as_a_kelvinlet_of_ten_millimetres_does) {
  const auto [cells, poisson] = GetParam();
  const MediumBlock block({.cells = cells, .poisson = poisson, .element = Element::nodal_pressure, .ways = {kThrough}});
  // The rim of the quadratic elements has the compliance of the mesh's own elements, which is less accurate for ν
  // near 0.5.
  const double allowed = poisson > 0.47 ? 0.13 : 0.1;
  for (const double apart : {0.0, 4.0, 9.0, 15.0, 25.0}) {
    const Vec3 on(1.3, 0.7, -11.0);
    const Vec3 x = on + apart * Vec3::UnitZ();
    const Mat3 expected = kelvinlet(x - on, SpreadCompliance::kSpread_mm, block.medium);
    EXPECT_LT((unbounded(block, x, on) - expected).norm(), allowed * expected.norm()) << apart << " mm apart";
  }
}
INSTANTIATE_TEST_SUITE_P(MeshesAndMedia, SpreadForces,
                         testing::Combine(testing::ValuesIn(test::meshes({10, 14})), testing::Values(0.3, 0.45, 0.49)));

class PlacesOnWays : public testing::TestWithParam<std::tuple<Element, double>> {};

TEST_P(PlacesOnWays, have_a_positive_compliance_on_one_way_and_on_both) {
  const auto [element, allowed] = GetParam();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-60.0, 60.0), aside(-15.0, 15.0);
  std::uniform_int_distribution<int> either(0, 1);
  const MediumBlock block({.cells = 8,
                           .regions = {"fat", "gland"},
                           .region_at = [](const Vec3& x) { return x.z() < 0.0 ? 0 : 1; },
                           .materials = {{0.002, 0.45}, {0.03, 0.45}},
                           .element = element,
                           .ways = {kThrough, {{-20.0, 5.0, -48.0}, Vec3(0.3, 0.0, 1.0).normalized(), 60.0}}});
  EXPECT_EQ(block.spread->way_near({-15.0, 4.0, -40.0}), 1);
  for (int trial = 0; trial < 30; ++trial) {
    constexpr int count = 12;
    const bool on_one_way = trial % 3 < 2;
    std::vector<SpreadCompliance::Place> places;
    for (int k = 0; k < count; ++k) {
      const int way = on_one_way ? trial % 3 : either(random);
      places.push_back(block.spread->place({aside(random), aside(random), along(random)}, way));
    }
    MatX F(3 * count, 3 * count), pressed(3 * count, 3 * count), under;
    for (int j = 0; j < count; ++j) {
      const SpreadCompliance::Place& on = places[static_cast<std::size_t>(j)];
      block.spread->press(on, under);
      for (int i = 0; i < count; ++i) {
        const SpreadCompliance::Place& at = places[static_cast<std::size_t>(i)];
        F.block<3, 3>(3 * i, 3 * j) = (*block.spread)(at, on);
        pressed.block<3, 3>(3 * i, 3 * j) = SpreadCompliance::at(at, under);
      }
    }
    EXPECT_LT((pressed - F).norm(), 1e-12 * F.norm());
    const Eigen::SelfAdjointEigenSolver<MatX> eigen(F);
    EXPECT_LT((F - F.transpose()).norm(), 1e-12 * F.norm());
    EXPECT_GT(eigen.eigenvalues()[0], -(on_one_way ? 1e-12 : allowed) * F.norm());
  }
}
// Quadratic elements contain the linear ones, so M is positive as a whole. Elements with averaged pressure are not
// contained in them; what is negative must be small beside the narrow part of the compliance.
INSTANTIATE_TEST_SUITE_P(Elements, PlacesOnWays,
                         testing::Values(std::tuple(Element::p1, 1e-12), std::tuple(Element::nodal_pressure, 1e-3)));

TEST(SpreadCompliance, ends_gradually_beside_its_ways) {
  const MediumBlock block({.cells = 6, .ways = {kThrough}});
  double before = 1.0;
  for (double off = 0.0; off < 30.0; off += 0.1) {
    const double known = block.spread->place({1.3 + off, 0.7, 3.0}).known;
    EXPECT_LE(known, before);
    EXPECT_NEAR(known, before, 0.02);
    before = known;
  }
  EXPECT_DOUBLE_EQ(block.spread->place({1.3 + 9.9, 0.7, 3.0}).known, 1.0);
  EXPECT_DOUBLE_EQ(block.spread->place({1.3 + 20.1, 0.7, 3.0}).known, 0.0);
}

TEST(SpreadCompliance, of_the_same_ways_has_as_many_rows) {
  const MediumBlock block({.cells = 6, .ways = {kThrough}});
  EXPECT_TRUE(SpreadCompliance::of({kThrough}, block.spread->matrix()));
  EXPECT_FALSE(SpreadCompliance::of({{kThrough.entry, kThrough.direction, 30.0}}, block.spread->matrix()));
  EXPECT_FALSE(SpreadCompliance::of({kThrough}, {}));
  // A matrix without anything between two ways is that of an earlier version, which was not positive.
  const NeedleWay beside{kThrough.entry + Vec3(5, 0, 0), kThrough.direction, kThrough.length_mm};
  const Eigen::Index rows = block.spread->matrix().rows();
  MatX apart = MatX::Zero(2 * rows, 2 * rows);
  apart.topLeftCorner(rows, rows) = apart.bottomRightCorner(rows, rows) = block.spread->matrix();
  EXPECT_FALSE(SpreadCompliance::of({kThrough, beside}, apart));
}

class NeedleOnItsWay : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(NeedleOnItsWay, needs_the_force_of_a_bonded_rigid_cylinder) {
  const auto [cells, poisson] = GetParam();
  MediumBlock block({.cells = cells, .poisson = poisson, .element = Element::nodal_pressure, .ways = {kThrough}});
  const NeedleLine line(block, 4.0, Vec3::UnitZ(), true);
  const auto thick = validate::bonded_cylinder(NeedleLine::kLength_mm, 0.635, NeedleLine::kWay_mm, block.medium);
  EXPECT_NEAR(line.lateral() / thick.lateral_N, 1.0, 0.04);
  EXPECT_NEAR(line.axial() / thick.axial_N, 1.0, 0.04);
}
// Elements of 14, 10 and 7 mm. As without planned paths, pieces of constant force make the needle 1 % too soft along
// its axis.
INSTANTIATE_TEST_SUITE_P(MeshesAndMedia, NeedleOnItsWay,
                         testing::Combine(testing::ValuesIn(test::meshes({7, 10, 14})), testing::Values(0.3, 0.45)));

TEST(SpreadCompliance, through_a_thin_layer_hardly_depends_on_the_mesh) {
  if (test::kSanitized) GTEST_SKIP() << test::kTooLongSanitized;
  const test::ThinLayer coarse(12, {kThrough}), fine(18, {kThrough});
  for (double z = -12.0; z <= 18.0; z += 1.5) {
    const Vec3 x(1.3, 0.7, z);
    const auto F = [&](const MediumBlock& block) -> Mat3 {
      return (*block.spread)(block.spread->place(x), block.spread->place(x));
    };
    EXPECT_LT((F(coarse) - F(fine)).norm(), 0.1 * F(fine).norm()) << z;
  }
}

}  // namespace
}  // namespace stylet

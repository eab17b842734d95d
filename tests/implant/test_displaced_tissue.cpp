// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds and structures in tissue that a probe displaces.
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/implant/displaced_tissue.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

constexpr double kSeed_mm = 4.5;

struct Block {
  TetMesh mesh = box_mesh({-40, -40, -40}, {40, 40, 40}, {4, 4, 4});
  Topology topology{mesh};
  Locator locator{mesh, topology};

  /// u(X) = shift + gradient · X at the nodes, and so everywhere.
  [[nodiscard]] Eigen::Matrix3Xf linear(const Mat3& gradient, const Vec3& shift) const {
    Eigen::Matrix3Xf u(3, mesh.node_count());
    for (Index k = 0; k < mesh.node_count(); ++k)
      u.col(k) = (shift + gradient * mesh.nodes[static_cast<std::size_t>(k)]).cast<float>();
    return u;
  }
};

class Draw {
 public:
  Vec3 vector(double size) { return size * Vec3(number_(random_), number_(random_), number_(random_)); }
  Mat3 matrix(double size) {
    Mat3 m;
    for (int i = 0; i < 3; ++i) m.col(i) = vector(size);
    return m;
  }

 private:
  std::mt19937 random_{5};
  std::uniform_real_distribution<double> number_{-1.0, 1.0};
};

SeedHistory seed_at(const Vec3& x, const Vec3& axis) {
  SeedHistory seed;
  seed.planned_mm = x - Vec3(0.4, -0.2, 1.0);
  seed.dropped_mm = seed.rest_mm = x;
  seed.by(SeedCause::bend) = seed.error_mm();
  seed.axis = axis;
  return seed;
}

TEST(LetTissueGoBack, takes_seeds_and_their_axes_to_the_material_in_a_linear_field) {
  const Block block;
  Draw draw;
  for (int trial = 0; trial < 50; ++trial) {
    const Mat3 gradient = draw.matrix(0.15);
    const Vec3 shift = draw.vector(3.0);
    const Vec3 material = draw.vector(20.0), along = draw.vector(1.0).normalized();
    const Mat3 F = Mat3::Identity() + gradient;
    std::vector<SeedHistory> seeds(1, seed_at(shift + F * material, (F * along).normalized()));
    let_tissue_go_back(block.locator, block.linear(gradient, shift), kSeed_mm, seeds);
    const SeedHistory& seed = seeds.front();
    EXPECT_LT((seed.rest_mm - material).norm(), 1e-3);
    EXPECT_LT((seed.axis - along).norm(), 1e-3);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& cause : seed.cause_mm) sum += cause;
    EXPECT_LT((sum - seed.error_mm()).norm(), 1e-12);
    EXPECT_LT((seed.by(SeedCause::probe) - (material - shift - F * material)).norm(), 1e-3);
  }
}

TEST(LetTissueGoBack, leaves_lost_seeds_and_those_outside_of_the_tissue) {
  const Block block;
  std::vector<SeedHistory> seeds(1, seed_at({1, 2, 3}, Vec3::UnitZ()));
  seeds.front().lost = true;
  seeds.push_back(seed_at({0, 0, 90}, Vec3::UnitZ()));
  const std::vector<SeedHistory> before = seeds;
  let_tissue_go_back(block.locator, block.linear(Mat3::Zero(), Vec3(0, -4, 0)), kSeed_mm, seeds);
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    EXPECT_EQ(seeds[k].rest_mm, before[k].rest_mm);
    EXPECT_EQ(seeds[k].axis, before[k].axis);
    EXPECT_EQ(seeds[k].by(SeedCause::probe), Vec3::Zero());
  }
}

/// D90 of a ball of tissue with seeds around it.
double d90(const std::vector<DoseStructure>& structures, const DosePlan& plan) {
  const auto dose = evaluate_dose(plan, find_source("i125_6711").value(), structures, {.prescription_Gy = 145.0});
  EXPECT_TRUE(dose.ok()) << dose.error().message();
  return dose->structures.front().dvh.dose_of_percent(90.0);
}

TEST(Displaced, seeds_and_structure_that_go_together_keep_their_dose_and_those_that_are_spread_lose_it) {
  const Block block;
  Draw draw;
  DoseStructure ball{.name = "ball", .region = "prostate"};
  for (int k = 0; k < 4000; ++k) {
    const Vec3 x = draw.vector(15.0);
    if (x.norm() > 15.0) continue;
    ball.samples.points.push_back(x);
    ball.samples.volume_mm3.push_back(4.0);
  }
  DosePlan plan;
  for (int k = 0; k < 30; ++k) {
    PlannedSource source;
    source.at_mm = draw.vector(14.0);
    source.axis = Vec3::UnitZ();
    source.has_axis = true;
    source.strength_U = 0.5;
    plan.sources.push_back(source);
  }
  const double before = d90({ball}, plan);
  const auto after = [&](const Mat3& gradient, const Vec3& shift) {
    const Eigen::Matrix3Xf u = block.linear(gradient, shift);
    return d90({displaced(block.locator, u, ball)}, displaced(block.locator, u, kSeed_mm, plan));
  };
  EXPECT_NEAR(after(Mat3::Zero(), Vec3(2, -5, 1)), before, 1e-3 * before);
  // A turn by 90° about x, which is a displacement with a large gradient: seeds turn with their tissue.
  Mat3 turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_NEAR(after(turn - Mat3::Identity(), Vec3::Zero()), before, 1e-3 * before);
  // Twice as far from each other, seeds give a quarter by distance alone, and less by absorption.
  EXPECT_LT(after(Mat3::Identity(), Vec3::Zero()), 0.25 * before);
}

}  // namespace
}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
// Tissue that stiffens under the tip (docs/theory/stiffening.md).
#include "coupling/near_field/medium_block.hpp"
#include "coupling/needle_in_block.hpp"
#include "coupling/tissue_response.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "support/count_allocations.hpp"
#include "support/sanitized.hpp"

#include <Eigen/Eigenvalues>

#include <functional>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace stylet {
namespace {

using test::BlockOptions;
using test::MediumBlock;
using test::NeedleInBlock;

TEST(DentLaw, is_a_parabola_with_its_slope_and_energy) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-3.0, 2.0);
  const auto any = [&] { return std::pow(10.0, exponent(random)); };
  for (int k = 0; k < 1000; ++k) {
    const DentLaw law{any(), any()};
    const double force = any();
    const double z = law.depth(force);
    EXPECT_NEAR(z / law.compliance + law.stiffening_MPa * z * z, force, 1e-12 * force);
    const double h = 1e-6 * force;
    EXPECT_NEAR((law.depth(force + h) - law.depth(force - h)) / (2.0 * h), law.slope(force), 1e-5 * law.slope(force));
    const double gained = law.complementary_energy(force + h) - law.complementary_energy(force - h);
    EXPECT_NEAR(gained / (2.0 * h), z, 1e-5 * z);
    EXPECT_LT(law.slope(force), law.compliance) << "stiffer than at first";
    EXPECT_NEAR(DentLaw::compliance_for(force, z, law.stiffening_MPa), law.compliance, 1e-6 * law.compliance);
  }
  const DentLaw linear{7.0, 0.0};
  EXPECT_EQ(linear.depth(2.0), 14.0);
  EXPECT_EQ(linear.slope(2.0), 7.0);
  EXPECT_EQ(linear.complementary_energy(2.0), 14.0);
}

TEST(TipDent, is_the_derivative_of_its_energy_in_any_direction) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int k = 0; k < 200; ++k) {
    Mat3 root;
    root << any(), any(), any();
    const TipDent dent{root * root.transpose() + 0.3 * Mat3::Identity(), 0.5};
    const Vec3 force = 2.0 * any();
    const TipDent::Under under = dent.under(force);
    constexpr double h = 1e-5;
    for (int i = 0; i < 3; ++i) {
      const TipDent::Under more = dent.under(force + h * Vec3::Unit(i));
      const TipDent::Under less = dent.under(force - h * Vec3::Unit(i));
      const double gained = (more.complementary_energy_Nmm - less.complementary_energy_Nmm) / (2.0 * h);
      EXPECT_NEAR(gained, (dent.compliance * under.linear)[i], 1e-7 * (1.0 + dent.compliance.norm() * force.norm()));
      const Vec3 slope = (more.linear - less.linear) / (2.0 * h);
      EXPECT_LT((slope - under.slope.col(i)).norm(), 1e-7);
    }
    const Mat3 tangent = dent.compliance * under.slope;
    EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-12 * tangent.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(tangent).eigenvalues()[0], 0.0);
  }
}

/// A tip and three pieces of shaft behind it, in stiffening tissue of two media.
class StiffTissue : public testing::Test {
 protected:
  static constexpr int kPoints = 4;

  StiffTissue() : block_(options()) {
    std::vector<Vec3> all{kTipAt};
    for (int k = 1; k < kPoints; ++k) all.push_back(kTipAt - 4.0 * k * Vec3::UnitZ());
    block_.prepare(all);
    shaft_.resize(kPoints - 1);
    for (int k = 1; k < kPoints; ++k) shaft_[static_cast<std::size_t>(k - 1)].point = k;
    make({0.03, 0.1}, {});
  }

  /// Makes the tissue with these laws, at rest. @param stiffening_MPa of the two media
  void make(std::vector<double> stiffening_MPa, const Creep& creep) {
    auto compliance = std::make_unique<NearFieldCompliance>(
        std::make_unique<TrackCompliance>(block_.store, *block_.locator, kPoints), block_.tissue, block_.kernel,
        NeedleKernel{}, kPoints, std::move(stiffening_MPa), creep.is_any());
    for (int k = 1; k < kPoints; ++k) {
      const Vec3 x = kTipAt - 4.0 * k * Vec3::UnitZ();
      compliance->add(block_.at(x), x, Placement::embedded, Vec3::UnitZ());
    }
    compliance->move_tip(block_.at(kTipAt), kTipAt);
    tissue_ = std::make_unique<TissueResponse>(std::move(compliance), creep, 0.635, kPoints);
  }

  static MediumBlock::Options options() {
    return {.cells = 8,
            .regions = {"soft", "hard"},
            .region_at = [](const Vec3& x) { return x.z() < 0.0 ? 0 : 1; },
            .materials = {{0.01, 0.45}, {0.03, 0.45}}};
  }

  /// Displacements of all points by forces [N] (3 points).
  VecX displacement(const VecX& forces) {
    for (std::size_t k = 0; k < shaft_.size(); ++k)
      shaft_[k].force = forces.segment<3>(3 * static_cast<Eigen::Index>(k) + 3);
    VecX u(3 * kPoints);
    for (int c = 0; c < kPoints; ++c) u.segment<3>(3 * c) = tissue_->displacement(c, contacts(forces));
    return u;
  }
  [[nodiscard]] ContactForces contacts(const VecX& forces) {
    tip_ = forces.head<3>();
    return {tip_, shaft_};
  }

  static inline const Vec3 kTipAt{0.9, -2.3, 2.5};
  MediumBlock block_;
  std::unique_ptr<TissueResponse> tissue_;
  std::vector<ShaftContact> shaft_;
  Vec3 tip_ = Vec3::Zero();
};

TEST_F(StiffTissue, stores_what_is_put_into_it_and_gives_it_back) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto any = [&] {
    VecX forces(3 * kPoints);
    for (double& f : forces) f = normal(random);
    forces.head<3>() *= 4.0;
    return forces;
  };
  // Work done on the tissue from one random state of forces to another, and back on another path, by Simpson's rule.
  const auto work = [&](const VecX& from, const VecX& to) {
    constexpr int pieces = 400;
    double sum = 0.0;
    VecX before = displacement(from);
    for (int k = 0; k < pieces; ++k) {
      const VecX middle = from + (k + 0.5) / pieces * (to - from);
      const VecX end = from + (k + 1.0) / pieces * (to - from);
      const VecX after = displacement(end);
      sum += middle.dot(after - before);
      before = after;
    }
    return sum;
  };
  for (int k = 0; k < 5; ++k) {
    const VecX a = any();
    const VecX b = any();
    const VecX c = any();
    displacement(a);
    const double at_a = tissue_->energy(contacts(a));
    displacement(b);
    const double at_b = tissue_->energy(contacts(b));
    EXPECT_NEAR(work(a, b), at_b - at_a, 1e-3 * (at_a + at_b));
    EXPECT_NEAR(work(a, b) + work(b, c) + work(c, a), 0.0, 1e-3 * (at_a + at_b));
  }
}

TEST_F(StiffTissue, is_linear_while_forces_are_small_and_far_from_the_tip) {
  VecX forces = VecX::Zero(3 * kPoints);
  forces << 1.0, 2.0, 3.0, 0.2, -0.1, 0.4, 0.3, 0.1, 0.2, -0.5, 0.2, 0.1;
  const MatX A = tissue_->compliance().matrix().topLeftCorner(3 * kPoints, 3 * kPoints);
  constexpr double small = 1e-7;
  EXPECT_LT((displacement(small * forces) - small * A * forces).norm(), 1e-5 * (small * A * forces).norm());
  forces.head<3>().setZero();
  EXPECT_LT((displacement(forces) - A * forces).norm(), 1e-12 * (A * forces).norm()) << "no force on the tip";
}

TEST_F(StiffTissue, gives_way_to_more_force_by_less_and_less_but_always_by_more) {
  VecX forces = VecX::Zero(3 * kPoints);
  double before = 0.0;
  double way_before = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= 40; ++k) {
    forces[2] = 0.25 * k;
    const double dent = displacement(forces)[2];
    EXPECT_GT(dent, before);
    EXPECT_LT(dent - before, way_before);
    way_before = dent - before;
    before = dent;
  }
}

/// The flat end of a rod, pressed into a Yeoh solid of 30 kPa with C20 = C10, deep inside an unbounded medium: an
/// independent axisymmetric finite element model (tests/reference/hyperelastic_punch.py).
struct Pressed {
  double poisson;
  double depth_mm;  ///< depth of the rod's end, far field included
  double force_N;
};
constexpr Pressed kYeohSolid[] = {
#include "hyperelastic_punch.inc"
};

class YeohSolid : public testing::TestWithParam<double> {
 protected:
  static constexpr double kYoung_MPa = 0.03;

  /// Force [N] on a tip inside tissue by a given depth, with the law of k₂ = stiffening × E.
  static std::function<double(double)> law(int cells, double poisson, double stiffening) {
    MediumBlock block({.cells = cells, .materials = {{kYoung_MPa, poisson}}, .element = Element::nodal_pressure});
    const Vec3 x(1.3, 0.7, -2.1);
    block.prepare({x});
    NearFieldCompliance compliance(std::make_unique<TrackCompliance>(block.store, *block.locator, 1), block.tissue,
                                   block.kernel, NeedleKernel{}, 1, std::vector<double>{stiffening * kYoung_MPa});
    compliance.move_tip(block.at(x), x);
    // The block's faces move as in an unbounded medium.
    std::vector<Mat3> field;
    for (const Index node : block.fixed)
      field.push_back(kelvinlet(block.tissue->node_position(node) - x, 1e-6, block.medium));
    const Mat3 own = compliance(0, 0) + block.lift(x, field);
    const TipDent dent = compliance.tip_dent();
    return [own, dent](double depth) {
      double low = 0.0;
      double high = depth / own(2, 2) * 100.0;
      for (int k = 0; k < 60; ++k) {
        const double force = 0.5 * (low + high);
        const Vec3 g = force * Vec3::UnitZ();
        const double moved = (own * g - dent.compliance * (g - dent.under(g).linear)).z();
        (moved < depth ? low : high) = force;
      }
      return low;
    };
  }
};

TEST_P(YeohSolid, under_a_rod_is_as_stiff_as_the_law_says_at_every_depth_on_any_mesh) {
  const double poisson = GetParam();
  for (const int cells : {7, 12}) {
    const auto ours = law(cells, poisson, 2.0);
    const auto linear = law(cells, poisson, 0.0);
    double deepest = 0.0;
    for (const Pressed& pressed : kYeohSolid) {
      if (pressed.poisson != poisson) continue;
      const double ratio = ours(pressed.depth_mm) / pressed.force_N;
      EXPECT_NEAR(ratio, 1.0, 0.05) << cells << " cells, " << pressed.depth_mm << " mm";
      deepest = std::max(deepest, pressed.depth_mm);
      std::cout << cells << " cells, " << pressed.depth_mm << " mm: " << ratio << ", linear "
                << linear(pressed.depth_mm) / pressed.force_N << '\n';
    }
    EXPECT_GT(deepest, 4.0);
  }
}
INSTANTIATE_TEST_SUITE_P(PoissonsRatio, YeohSolid, testing::Values(0.45, 0.49));

/// The same tissue with creep, with and without a dent that stiffens.
class CreepingTissue : public StiffTissue {
 protected:
  static constexpr Creep kCreep{3.0, 0.2};
  static inline const std::vector<std::vector<double>> kStiffenings{{}, {0.03, 0.1}};

  /// Lets forces act for h seconds more. @return displacements
  VecX act(const VecX& forces, double h) {
    tissue_->begin(h);
    displacement(forces);
    tissue_->end(contacts(forces), {});
    return displacement(forces);
  }
  [[nodiscard]] VecX lasting(const VecX& forces) {
    const MatX lasting = tissue_->lasting_forces(contacts(forces));
    return Eigen::Map<const VecX>(lasting.data(), lasting.size());
  }
  [[nodiscard]] MatX wide() const { return tissue_->compliance().wide().topLeftCorner(3 * kPoints, 3 * kPoints); }
};

TEST_F(CreepingTissue, loses_work_in_every_closed_way_of_forces_and_never_gives_any) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-2.0, 0.5);
  for (const auto& stiffening_MPa : kStiffenings) {
    for (int loop = 0; loop < 4; ++loop) {
      make(stiffening_MPa, kCreep);
      VecX now = VecX::Zero(3 * kPoints);
      VecX u = displacement(now);
      VecX p = lasting(now);
      double work = 0.0;
      double lost = 0.0;  // by the damper: τ (r − 1) ṁᵀ F ṁ
      const auto go = [&](const VecX& to, double time, int pieces) {
        const double h = time / pieces;
        const VecX from = now;
        for (int k = 1; k <= pieces; ++k) {
          const VecX before = now;
          now = from + static_cast<double>(k) / pieces * (to - from);
          const VecX u_before = std::exchange(u, act(now, h));
          const VecX p_before = std::exchange(p, lasting(now));
          work += 0.5 * (now + before).dot(u - u_before);
          lost += kCreep.time_s / (h * (kCreep.factor - 1.0)) * (p - p_before).dot(wide() * (p - p_before));
        }
      };
      for (int leg = 0; leg < 5; ++leg) {
        VecX to(3 * kPoints);
        for (double& f : to) f = normal(random);
        to.head<3>() *= 4.0;
        go(to, std::pow(10.0, exponent(random)), 400);
        EXPECT_NEAR(tissue_->energy(contacts(now)), work - lost, 0.02 * work) << "stored is what is not lost";
        EXPECT_GT(lost, 0.0);
      }
      go(VecX::Zero(3 * kPoints), 0.1, 400);
      EXPECT_GT(tissue_->energy(contacts(now)), 0.0) << "it has not gone back yet";
      go(now, 40.0 * kCreep.time_s, 2000);
      EXPECT_NEAR(work, lost, 0.02 * lost);
      EXPECT_LT(u.norm(), 1e-12);
    }
  }
}

TEST_F(CreepingTissue, yields_at_once_as_elastic_tissue_does_and_later_by_the_wide_part_more) {
  VecX forces = VecX::Zero(3 * kPoints);
  forces << 0.5, 0.3, 3.0, 0.2, -0.1, 0.4, 0.3, 0.1, 0.2, -0.5, 0.2, 0.1;
  for (const auto& stiffening_MPa : kStiffenings) {
    make(stiffening_MPa, {});
    const VecX elastic = displacement(forces);
    make(stiffening_MPa, kCreep);
    EXPECT_LT((act(forces, 1e-9) - elastic).norm(), 1e-7 * elastic.norm());
    EXPECT_LT((act(forces, 1e9) - elastic - 2.0 * wide() * forces).norm(), 1e-7 * elastic.norm());
    EXPECT_LT((act(VecX::Zero(3 * kPoints), 1e-9) - 2.0 * wide() * forces).norm(), 1e-7 * elastic.norm());
  }
}

TEST_F(CreepingTissue, creeps_by_a_part_of_its_compliance_that_is_smooth_at_the_needle) {
  make({}, kCreep);
  const MatX F = wide();
  const MatX A = tissue_->compliance().matrix().topLeftCorner(3 * kPoints, 3 * kPoints);
  EXPECT_LT((F - F.transpose()).norm(), 1e-14 * F.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(F).eigenvalues()[0], 0.0);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(A - F).eigenvalues()[0], 0.0);
  EXPECT_LT(F(2, 2), 0.15 * A(2, 2)) << "most of what a tip moves by is its own dent";
  const int last = 3 * (kPoints - 1);
  EXPECT_NEAR(F(2, last + 2), A(2, last + 2), 0.5 * A(2, last + 2)) << "far away all is wide";
}

/// A block of one tissue with a strong skin, under which the dent stiffens.
BlockOptions stiff_block(int cells, double puncture_N, double cutting_N) {
  BlockOptions options;
  options.cells = {cells, cells, cells};
  options.region_at = [](const Vec3&) { return 0; };
  options.laws[0] = {cutting_N, puncture_N, {18e-3, 11e-3, 250e-6, 50.0}, false, true, -1};
  options.laws[0].stiffening_MPa = 0.1;
  return options;
}

TEST(StiffDent, takes_the_force_of_a_flat_punch_that_stiffens_on_any_mesh) {
  if (test::kSanitized) GTEST_SKIP() << test::kTooLongSanitized;
  // A punch on a half space has k₁ = 2RE/(1−ν²). The part of its dent without the needle's scale stays linear; it is
  // the dent of the same force spread over kScale_mm, doubled by its image (docs/theory/near_field.md §2).
  constexpr double k1 = 2.0 * 0.635 * 0.06 / (1.0 - 0.45 * 0.45);
  const double shear_MPa = 0.06 / (2.0 * 1.45);
  const double spread =
      2.0 * (5.0 - 6.0 * 0.45) / (16.0 * std::numbers::pi * shear_MPa * 0.55 * NeedleKernel::kScale_mm);
  const DentLaw law{1.0 / k1 - spread, 0.1};
  for (const int cells : {5, 8, 14}) {
    const auto press = [&](double stiffening_MPa, double force) {
      BlockOptions options = stiff_block(cells, 50.0, 0.1);
      options.laws[0].stiffening_MPa = stiffening_MPa;
      NeedleInBlock run(options);
      run.aim({2.0, 3.0, 0.0}, Vec3::UnitZ(), 0.0);
      while (run.depth < 30.0 && (run.forces.empty() || run.forces.back() < force))
        run.go(run.depth + 0.05, 20.0, 5e-3);
      EXPECT_EQ(run.flags, 0u) << cells;
      return std::pair{run.depth, run.forces.back()};
    };
    // The block's walls reduce the dent of a half space, as in linear tissue.
    const auto [linear_mm, linear_N] = press(0.0, 0.3);
    const double walls = 1.0 / k1 - linear_mm / linear_N;
    EXPECT_NEAR(walls * k1, 0.0, 0.05) << cells;
    const auto [depth, force] = press(0.1, 3.0);
    EXPECT_NEAR(depth, law.depth(force) + (spread - walls) * force, 0.02 * depth) << cells;
  }
}

TEST(StiffDent, gives_back_all_the_work_that_pressed_it_in) {
  NeedleInBlock run(stiff_block(8, 50.0, 0.1));
  run.aim({2.0, 3.0, 0.0}, Vec3::UnitZ(), 0.0);
  run.go(6.0);
  const double put_in = run.work;
  EXPECT_GT(run.peak(), 2.0);
  EXPECT_NEAR(run.insertion->tissue_energy(), put_in, 0.01 * put_in);
  run.go(0.0);
  EXPECT_NEAR(run.work, 0.0, 1e-3 * put_in);
  EXPECT_EQ(run.flags, 0u);
}

TEST(StiffDent, an_insertion_goes_on_without_jumps_and_comes_out_again) {
  BlockOptions options = stiff_block(8, 3.0, 1.5);
  NeedleInBlock run(options);
  run.aim({2.0, 3.0, 0.0}, Vec3::UnitZ(), -1.0);
  run.go(50.0);
  ASSERT_EQ(run.count(EventKind::puncture), 1);
  EXPECT_NEAR(run.first(EventKind::puncture)->force, 3.0, 0.05);
  const auto deep = static_cast<std::size_t>(
      std::find_if(run.depths.begin(), run.depths.end(), [](double depth) { return depth > 25.0; }) -
      run.depths.begin());
  // A step changes the base depth by 0.02 mm or friction by 0.0006 N; contacts are created and handed over all the
  // time.
  for (std::size_t i = deep + 1; i < run.forces.size(); ++i)
    EXPECT_LT(std::abs(run.forces[i] - run.forces[i - 1]), 0.005) << run.depths[i];
  run.go(-1.0);
  EXPECT_EQ(run.count(EventKind::withdrawn), 1);
  EXPECT_EQ(run.flags, 0u);
}

TEST(StiffDent, a_step_with_one_does_not_allocate) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "allocations cannot be counted here";
  NeedleInBlock run(stiff_block(6, 3.0, 1.5));
  run.aim({2.0, 3.0, 0.0}, Vec3::UnitZ(), -1.0);
  run.insertion->prepare(200.0);
  long allocations = 0;
  while (run.depth < 40.0) {
    run.depth += 0.04;
    const test::AllocationCount count;
    run.report = run.insertion->step(run.pose(), 2e-3);
    allocations += count.count();
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(run.report.contacts, 5);
}

}  // namespace
}  // namespace stylet

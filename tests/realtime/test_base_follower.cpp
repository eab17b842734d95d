// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/base_follower.hpp"

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <cmath>
#include <functional>
#include <random>

using namespace stylet;

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

VirtualCoupling coupling(const VirtualCouplingSettings& settings = {}) {
  const DeviceTraits device{
      .name = "arm", .force = true, .torque = true, .damping_N_s_per_mm = 1e3, .damping_Nmm_s_per_rad = 1e6};
  auto made = VirtualCoupling::create(settings, device, 1e-3);
  EXPECT_TRUE(made.ok());
  return *made;
}

constexpr BaseFollower::Limits kUnlimited{.speed_mm_per_s = 1e9, .turn_rad_per_s = 1e9};

Pose at(double z) { return {{0, 0, z}, Eigen::Quaterniond::Identity()}; }

Vec6 place(const Pose& p) {
  Vec6 x;
  x << p.origin, rotation_between(Eigen::Quaterniond::Identity(), p.rotation);
  return x;
}

/// A random symmetric, positive definite stiffness with eigenvalues between `softest` and `stiffest`; angles are
/// multiplied by the lever to be lengths.
Mat6 random_stiffness(unsigned seed, double softest, double stiffest, double lever) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Mat6 any;
  for (int k = 0; k < 36; ++k) any.data()[k] = normal(random);
  const Mat6 Q = Eigen::HouseholderQR<Mat6>(any).householderQ();
  std::uniform_real_distribution<double> exponent(std::log(softest), std::log(stiffest));
  Vec6 eigenvalue;
  for (double& e : eigenvalue) e = std::exp(exponent(random));
  Mat6 scale = Mat6::Identity();
  scale.diagonal().tail<3>().setConstant(lever);
  return scale * Q * eigenvalue.asDiagonal() * Q.transpose() * scale;
}

/// Moves the handle by 0.05 mm per step to `depth` along z and waits there. @return the largest force and the last
/// state
struct Trial {
  double largest_N = 0.0;
  double last_N = 0.0;
  double base_mm = 0.0;
};
Trial push(const std::function<double(double z)>& force, double depth, int steps, double dt = 1e-3,
           const VirtualCouplingSettings& settings = {}) {
  BaseFollower follower(kUnlimited, coupling(settings));
  follower.start(at(0.0));
  Trial trial;
  for (int k = 1; k <= steps; ++k) {
    const double z = follower.follow(at(std::min(0.05 * k, depth)), {{0, 0, trial.last_N}, {0, 0, 0}}, dt).origin.z();
    trial.last_N = force(z);
    trial.base_mm = z;
    trial.largest_N = std::max(trial.largest_N, std::abs(trial.last_N));
  }
  return trial;
}

}  // namespace

TEST(BaseFollower, with_nothing_to_hold_it_the_base_goes_where_the_handle_goes) {
  const Trial trial = push([](double) { return 0.0; }, 10.0, 1000);
  EXPECT_NEAR(trial.base_mm, 10.0, 1e-6);
}

TEST(BaseFollower, finds_the_balance_of_any_linear_body_however_stiff_at_any_period) {
  const VirtualCouplingSettings s;
  const double lever = coupling(s).lever_mm();
  const Pose handle{{1.0, -2.0, 3.0}, Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Vec3(2, 1, 2) / 3.0))};
  for (unsigned seed = 0; seed < 60; ++seed) {
    for (const double dt : {1e-4, 1e-3, 1e-2}) {
      // The stiffnesses range from free air to a needle end-on against bone. Every third body exceeds that range: it
      // may oscillate by 0.1 mm until its stiffness is known, and needs the limit on speed.
      const bool beyond = seed % 3 == 0;
      const Mat6 body = random_stiffness(seed, beyond ? 1e-3 : 1e-2, beyond ? 1e5 : 2e3, lever);
      BaseFollower follower(beyond ? BaseFollower::Limits{} : kUnlimited, coupling(s));
      follower.start({});
      Vec6 hand = Vec6::Zero();
      double largest = 0.0;
      for (int k = 0; k < 5000; ++k) {
        const Pose& base = follower.follow(handle, {hand.head<3>(), hand.tail<3>()}, dt);
        hand = body * place(base);
        if (k > 100) largest = std::max(largest, hand.head<3>().norm());
      }
      const Wrench pull = coupling(s).on_base(handle, {}, follower.base(), {});
      EXPECT_LT((pull.force - hand.head<3>()).norm(), beyond ? 1e-3 : 1e-6) << "seed " << seed << ", dt " << dt;
      EXPECT_LT((pull.torque - hand.tail<3>()).norm(), beyond ? 1e-2 : 1e-4) << "seed " << seed << ", dt " << dt;
      EXPECT_LT(largest, beyond ? 1e4 : 4.0) << "it rang; seed " << seed << ", dt " << dt;
    }
  }
}

TEST(BaseFollower, against_bone_a_thousand_times_as_stiff_as_the_coupling_the_hand_feels_the_coupling) {
  // Free air for 2 mm, then bone. The base enters it by 0.05 mm in a step, to which an explicit method would respond
  // with 50 N.
  for (const double k : {1.0, 100.0, 1300.0, 1e5}) {
    const Trial trial = push([k](double z) { return k * std::max(0.0, z - 2.0); }, 10.0, 4000);
    const double balance = k / (k + 0.5) * 0.5 * 8.0;
    EXPECT_NEAR(trial.last_N, balance, 1e-3 * balance) << k;
    EXPECT_LT(trial.largest_N, std::max(1.01 * balance, 0.06 * k)) << k << ": no more than the first step into it";
  }
}

TEST(BaseFollower, comes_off_bone_again_without_sticking_to_it) {
  BaseFollower follower(kUnlimited, coupling());
  follower.start(at(0.0));
  const auto bone = [](double z) { return 1300.0 * std::max(0.0, z - 2.0); };
  double force = 0.0;
  for (int k = 0; k < 1000; ++k) force = bone(follower.follow(at(10.0), {{0, 0, force}, {0, 0, 0}}, 1e-3).origin.z());
  ASSERT_NEAR(force, 4.0, 0.01);
  for (int k = 0; k < 100; ++k) force = bone(follower.follow(at(0.0), {{0, 0, force}, {0, 0, 0}}, 1e-3).origin.z());
  EXPECT_LT(follower.base().origin.z(), 0.1) << "a tenth of a second later";
}

TEST(BaseFollower, friction_that_sticks_and_slides_stays_within_its_limit) {
  // Elastic up to 2 N, then sliding, like a shaft in tissue.
  for (const double k : {1.0, 50.0, 1000.0}) {
    double anchor = 0.0;
    double largest_gap = 0.0;
    BaseFollower follower(kUnlimited, coupling());
    follower.start(at(0.0));
    double force = 0.0;
    for (int step = 0; step < 6000; ++step) {
      const double hand = 15.0 * std::sin(2e-3 * step);
      const double z = follower.follow(at(hand), {{0, 0, force}, {0, 0, 0}}, 1e-3).origin.z();
      anchor = std::clamp(anchor, z - 2.0 / k, z + 2.0 / k);
      force = k * (z - anchor);
      largest_gap = std::max(largest_gap, std::abs(hand - z));
    }
    // In balance the handle is 2 N / (0.5 N/mm) = 4 mm ahead.
    EXPECT_LT(largest_gap, 4.5) << k;
  }
}

TEST(BaseFollower, a_body_that_slides_viscously_is_followed_without_ringing) {
  // Viscous friction acts on the base through the elasticity k of tissue and shaft. 0.002 N s/mm corresponds to a
  // cutting tip, 0.01 N s/mm to a shaft 40 mm deep with friction of 250 N s/m².
  for (const double k : {0.3, 3.0, 30.0}) {
    for (const double c : {0.002, 0.01, 0.1}) {
      for (const double dt : {2.5e-4, 1e-3, 4e-3}) {
        const double speed = 20.0;
        double anchor = 0.0;
        double largest = 0.0;
        BaseFollower follower(kUnlimited, coupling());
        follower.start(at(0.0));
        double force = 0.0;
        for (double t = 0.0; t < 4.0; t += dt) {
          const double z = follower.follow(at(speed * t), {{0, 0, force}, {0, 0, 0}}, dt).origin.z();
          // Solves k (z − a) = c (a − a₀)/dt for a.
          anchor = (k * z + c / dt * anchor) / (k + c / dt);
          force = k * (z - anchor);
          if (t > 3.0) largest = std::max(largest, std::abs(force - c * speed));
        }
        EXPECT_LT(largest, 0.1 * c * speed) << "k " << k << ", c " << c << ", dt " << dt;
      }
    }
  }
}

TEST(BaseFollower, held_it_stays_and_goes_on_without_a_jolt) {
  BaseFollower follower(BaseFollower::Limits{}, coupling());
  follower.start(at(0.0));
  double force = 0.0;
  const auto go = [&](double z) { force = 2.0 * follower.follow(at(z), {{0, 0, force}, {0, 0, 0}}, 1e-3).origin.z(); };
  for (int k = 0; k < 1000; ++k) go(5.0);
  ASSERT_NEAR(follower.base().origin.z(), 1.0, 1e-9);
  for (int k = 0; k < 100; ++k) follower.hold();
  EXPECT_NEAR(follower.base().origin.z(), 1.0, 1e-9);
  EXPECT_EQ(follower.twist().velocity, Vec3::Zero());
  go(5.0);
  EXPECT_NEAR(follower.base().origin.z(), 1.0, 1e-9) << "found again where it was";
  follower.hold();
  go(8.0);
  EXPECT_LT(follower.base().origin.z(), 1.6 + 1e-9) << "and no further than its new balance where it was not";
}

TEST(BaseFollower, a_handle_that_jumps_moves_the_base_no_faster_than_allowed) {
  const BaseFollower::Limits limits{.speed_mm_per_s = 100.0, .turn_rad_per_s = 2.0};
  const Pose far{{0, 300, 400}, Eigen::Quaterniond(Eigen::AngleAxisd(3.0, Vec3::UnitX()))};
  for (const bool coupled : {false, true}) {
    BaseFollower follower = coupled ? BaseFollower(limits, coupling()) : BaseFollower(limits);
    follower.start({});
    Pose before;
    for (int k = 0; k < 10'000; ++k) {
      const Pose base = follower.follow(far, {}, 1e-3);
      ASSERT_LE((base.origin - before.origin).norm(), 0.1 + 1e-12);
      ASSERT_LE(rotation_between(before.rotation, base.rotation).norm(), 2e-3 + 1e-12);
      before = base;
    }
    EXPECT_NEAR((before.origin - far.origin).norm(), 0.0, 1e-3) << "and it gets there";
    EXPECT_NEAR(rotation_between(before.rotation, far.rotation).norm(), 0.0, 1e-3);
  }
}

TEST(BaseFollower, without_a_coupling_the_base_is_the_handle) {
  BaseFollower follower(BaseFollower::Limits{});
  follower.start({});
  const Pose near{{0.1, -0.05, 0.02}, Eigen::Quaterniond(Eigen::AngleAxisd(0.001, Vec3::UnitX()))};
  const Pose& base = follower.follow(near, {}, 1e-3);
  EXPECT_NEAR((base.origin - near.origin).norm(), 0.0, 1e-15);
  EXPECT_NEAR(rotation_between(base.rotation, near.rotation).norm(), 0.0, 1e-15);
}

TEST(BaseFollower, a_force_that_is_not_finite_does_not_reach_the_base) {
  BaseFollower follower(kUnlimited, coupling());
  follower.start(at(0.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 100; ++k) {
    const Pose& base = follower.follow(at(1.0), k % 3 == 0 ? Wrench{{nan, 0, 0}, {0, nan, 0}} : Wrench{}, 1e-3);
    ASSERT_TRUE(base.origin.allFinite());
    ASSERT_TRUE(base.rotation.coeffs().allFinite());
  }
}

TEST(BaseFollower, forces_beyond_all_bounds_do_not_spoil_it) {
  BaseFollower follower(kUnlimited, coupling());
  follower.start(at(0.0));
  for (int k = 0; k < 3000; ++k) {
    const double huge = k % 100 == 50 ? 1e300 : 0.0;
    const Pose& base = follower.follow(at(1.0), {{huge, 0, 0}, {0, huge, 0}}, 1e-3);
    ASSERT_TRUE(base.origin.allFinite()) << k;
    if (k % 100 == 50) follower.start(at(0.0));
  }
}

TEST(BaseFollower, is_as_good_after_a_hundred_thousand_steps_as_after_one) {
  // At a constant force S decreases forever, down to tiny numbers.
  BaseFollower follower(kUnlimited, coupling());
  follower.start(at(0.0));
  double force = 0.0;
  for (int k = 0; k < 100'000; ++k) {
    const double z = follower.follow(at(5e-3 * k), {{0, 0, force}, {0, 0, 0}}, 1e-3).origin.z();
    force = std::min(1.0, z);
    ASSERT_TRUE(std::isfinite(z)) << k;
  }
  EXPECT_NEAR(follower.base().origin.z(), 5e-3 * 99'999 - 1.0 / 0.5, 0.01);
}

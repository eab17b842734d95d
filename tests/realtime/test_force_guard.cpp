// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/force_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace stylet;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDt = 1e-3;

ForceGuard guard(const ForceGuardSettings& settings = {}) {
  auto made = ForceGuard::create(settings);
  EXPECT_TRUE(made.ok());
  return *made;
}

/// A guard that has passed this force for a long time.
ForceGuard settled(const Wrench& w, const ForceGuardSettings& settings = {}) {
  ForceGuard g = guard(settings);
  for (int k = 0; k < 2000; ++k) g.filter(w, true, kDt);
  return g;
}

Wrench push(double newton) { return {{0, 0, newton}, {0, 0, 0}}; }

/// Random results of a broken computation: NaN, infinite, huge and denormal values.
Wrench nonsense(std::mt19937& random) {
  std::uniform_int_distribution<int> kind(0, 9);
  std::normal_distribution<double> normal(0.0, 8.0);
  Wrench w;
  w.force = {normal(random), normal(random), normal(random)};
  w.torque = 30.0 * Vec3(normal(random), normal(random), normal(random));
  std::uniform_int_distribution<int> axis(0, 2);
  switch (kind(random)) {
    case 0:
      w.force[axis(random)] = kNaN;
      break;
    case 1:
      w.torque[axis(random)] = kInf;
      break;
    case 2:
      w.force[axis(random)] = -kInf;
      break;
    case 3:
      w.force *= 1e6;
      break;
    case 4:
      w.torque *= 1e9;
      break;
    case 5:
      w.force.setConstant(std::numeric_limits<double>::max());  // the components are finite, but the norm is not
      break;
    case 6:
      w.force.setConstant(std::numeric_limits<double>::denorm_min());
      break;
    default:
      break;
  }
  return w;
}

double duration(std::mt19937& random) {
  std::uniform_int_distribution<int> kind(0, 12);
  std::uniform_real_distribution<double> length(1e-5, 5e-3);
  switch (kind(random)) {
    case 0:
      return 0.0;
    case 1:
      return -1.0;
    case 2:
      return kNaN;
    case 3:
      return kInf;
    default:
      return length(random);
  }
}

}  // namespace

TEST(ForceGuard, whatever_comes_in_what_goes_out_is_finite_limited_and_changes_no_faster_than_allowed) {
  ForceGuardSettings s;
  constexpr double rounding = 1e-12;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::bernoulli_distribution good(0.02 * (seed % 50));
    ForceGuard g = guard(s);
    Wrench before;
    for (int k = 0; k < 1000; ++k) {
      const double dt = duration(random);
      const Wrench after = g.filter(nonsense(random), good(random), dt);
      ASSERT_TRUE(after.finite());
      ASSERT_LE(after.force.norm(), s.max_force_N);
      ASSERT_LE(after.torque.norm(), s.max_torque_Nmm);
      const double time = dt > 0.0 && std::isfinite(dt) ? dt : 0.0;
      ASSERT_LE((after.force - before.force).norm(), s.force_slew_N_per_s * time + rounding);
      ASSERT_LE((after.torque - before.torque).norm(), s.torque_slew_Nmm_per_s * time + rounding * 100);
      before = after;
    }
  }
}

TEST(ForceGuard, lets_forces_within_the_limits_through_unchanged) {
  const Wrench w{{1, -2, 3}, {40, 50, -60}};
  const ForceGuard g = settled(w);
  EXPECT_EQ(g.sent().force, w.force);
  EXPECT_EQ(g.sent().torque, w.torque);
  EXPECT_EQ(g.counts().saturated, 0);
}

TEST(ForceGuard, saturates_the_magnitude_and_keeps_the_direction) {
  const ForceGuard g = settled({{300, 0, 400}, {0, -900, 0}});
  EXPECT_NEAR((g.sent().force - Vec3(6, 0, 8)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((g.sent().torque - Vec3(0, -300, 0)).norm(), 0.0, 1e-9);
  EXPECT_GT(g.counts().saturated, 0);
}

TEST(ForceGuard, a_drop_at_a_puncture_takes_as_long_as_the_slew_rate_says) {
  ForceGuard g = settled(push(5));
  for (int k = 1; k <= 4; ++k) EXPECT_NEAR(g.filter(push(1), true, kDt).force.z(), 5.0 - k, 1e-9);
  EXPECT_NEAR(g.filter(push(1), true, kDt).force.z(), 1.0, 1e-9);
  EXPECT_GE(g.counts().slewed, 3);
}

TEST(ForceGuard, a_late_result_fades_linearly_to_exactly_nothing_within_the_stated_time) {
  for (const Wrench& bad : {push(5), push(kNaN), Wrench{{1, 1, 1}, {0, -kInf, 0}}}) {
    const bool flagged = bad.finite();
    ForceGuardSettings s;
    ForceGuard g = settled({{0, 3, 4}, {100, 0, 0}}, s);
    const int steps = static_cast<int>(std::lround(s.fade_s / kDt));
    for (int k = 1; k <= steps; ++k) {
      const Wrench& sent = g.filter(bad, !flagged, kDt);
      const double left = 1.0 - static_cast<double>(k) / steps;
      ASSERT_NEAR((sent.force - left * Vec3(0, 3, 4)).norm(), 0.0, 1e-9) << k;
      ASSERT_NEAR((sent.torque - left * Vec3(100, 0, 0)).norm(), 0.0, 1e-8) << k;
    }
    g.filter(bad, !flagged, kDt);
    EXPECT_EQ(g.sent().force, Vec3::Zero());
    EXPECT_EQ(g.sent().torque, Vec3::Zero());
    EXPECT_EQ(g.gain(), 0.0);
    EXPECT_EQ(g.counts().fades, 1);
    EXPECT_EQ(g.counts().bad, steps + 1);
  }
}

TEST(ForceGuard, a_force_at_its_limit_fades_in_time_too) {
  ForceGuardSettings s;
  s.fade_s = s.max_force_N / s.force_slew_N_per_s;
  ForceGuard g = settled(push(1e3), s);
  EXPECT_NEAR(g.sent().force.z(), s.max_force_N, 1e-9);
  for (double t = 0.0; t < s.fade_s + 0.5 * kDt; t += kDt) g.filter({}, false, kDt);
  EXPECT_EQ(g.sent().force, Vec3::Zero());
}

TEST(ForceGuard, forces_return_gradually_and_completely) {
  ForceGuardSettings s;
  ForceGuard g = settled(push(4), s);
  for (int k = 0; k < 100; ++k) g.filter({}, false, kDt);
  const int steps = static_cast<int>(std::lround(s.recover_s / kDt));
  for (int k = 1; k <= steps; ++k) ASSERT_NEAR(g.filter(push(4), true, kDt).force.z(), 4.0 * k / steps, 1e-9) << k;
  EXPECT_EQ(g.filter(push(4), true, kDt).force.z(), 4.0);
}

TEST(ForceGuard, one_bad_result_among_good_ones_is_hardly_felt) {
  ForceGuard g = settled(push(4));
  double least = 4.0;
  for (int k = 0; k < 1000; ++k) least = std::min(least, g.filter(push(4), k % 100 != 0, kDt).force.z());
  EXPECT_LT(least, 4.0);
  EXPECT_GT(least, 4.0 * 0.95);
}

TEST(ForceGuard, results_good_and_bad_by_turns_lose) {
  ForceGuard g = settled(push(4));
  for (int k = 0; k < 400; ++k) g.filter(push(4), k % 2 == 0, kDt);
  EXPECT_LT(g.sent().force.z(), 0.2);
}

TEST(ForceGuard, at_the_start_forces_come_gradually) {
  ForceGuard g = guard();
  EXPECT_LT(g.filter(push(4), true, kDt).force.z(), 0.1);
}

TEST(ForceGuard, settings_that_cannot_be_kept_are_refused_with_values_and_cure) {
  ForceGuardSettings s;
  s.fade_s = 0.005;  // too short, because 10 N at 1000 N/s take 10 ms
  auto made = ForceGuard::create(s);
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().what.find("0.005 s is too short"), std::string::npos) << made.error().message();
  EXPECT_NE(made.error().what.find("0.01 s"), std::string::npos) << made.error().message();
  EXPECT_FALSE(made.error().cure.empty());

  s = {};
  s.recover_s = 0.01;
  EXPECT_EQ(ForceGuard::create(s).error().where, "force guard, recover_s");
  for (const double bad : {0.0, -1.0, kNaN, kInf}) {
    s = {};
    s.max_force_N = bad;
    EXPECT_EQ(ForceGuard::create(s).error().where, "force guard, max_force_N");
  }
}

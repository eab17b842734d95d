// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

using namespace stylet;

namespace {

constexpr double kT = 1e-3;

PassivityControl::Settings settings(double max_damping) {
  return {.max_damping_N_s_per_mm = max_damping, .lever_mm = 20.0};
}

/// A handle of 0.1 kg with little friction at a virtual wall with a delay, which is unstable without control. The
/// motion between samples is integrated with small steps. @return ratio of the largest deflection in the second half to
/// that in the first half
double growth(double max_damping) {
  PassivityControl control(settings(max_damping));
  const double mass = 0.1e-3;  // N s²/mm
  const double damping = 1e-5;
  const double stiffness = 1.0;
  double x = 1.0;
  double v = 0.0;
  std::deque<double> delayed(3, 0.0);
  double early = 0.0;
  double late = 0.0;
  constexpr int kPeriods = 1000;
  for (int k = 0; k < kPeriods; ++k) {
    delayed.push_back(-stiffness * x);
    const Wrench wanted{{delayed.front(), 0, 0}, {0, 0, 0}};
    delayed.pop_front();
    const Wrench sent = control.control(wanted, {{v, 0, 0}, {0, 0, 0}}, kT);
    const double from = x;
    constexpr int kParts = 50;
    for (int part = 0; part < kParts; ++part) {
      v += (sent.force.x() - damping * v) / mass * kT / kParts;
      x += v * kT / kParts;
    }
    control.observe(sent, {x - from, 0, 0}, Vec3::Zero());
    (k < kPeriods / 2 ? early : late) = std::max(k < kPeriods / 2 ? early : late, std::abs(x));
    if (std::abs(x) > 1e6) break;
  }
  return late / early;
}

}  // namespace

TEST(PassivityControl, books_what_the_hand_puts_in_and_gets_back) {
  PassivityControl control(settings(1.0));
  control.observe({{-2, 0, 0}, {0, -10, 0}}, {3, 1, 0}, {0, 0.1, 0});
  EXPECT_NEAR(control.energy_Nmm(), 6.0 + 1.0, 1e-12)
      << "the hand pushed against 2 N over 3 mm and turned against 10 N mm";
  control.observe({{-2, 0, 0}, {0, 0, 0}}, {-4, 0, 0}, Vec3::Zero());
  EXPECT_NEAR(control.energy_Nmm(), -1.0, 1e-12);
  EXPECT_NEAR(control.lowest_Nmm(), -1.0, 1e-12);
}

TEST(PassivityControl, leaves_the_force_of_a_passive_body_alone) {
  // A finely sampled spring that is loaded and released many times.
  PassivityControl control(settings(1.0));
  double x = 0.0;
  for (int k = 0; k < 100'000; ++k) {
    const Wrench spring{{-0.5 * std::max(x, 0.0) - 1e-3, 0, 0}, {0, 0, 0}};
    const double next = 5.0 - 5.0 * std::cos(1e-3 * (k + 1));
    const Twist twist{{(next - x) / kT, 0, 0}, {0, 0, 0}};
    const Wrench sent = control.control(spring, twist, kT);
    ASSERT_EQ(sent.force, spring.force) << k;
    // The force held is the mean over the motion, so that sampling generates no energy.
    control.observe({{-0.25 * (x + next) - 1e-3, 0, 0}, {0, 0, 0}}, {next - x, 0, 0}, Vec3::Zero());
    if (control.energy_Nmm() < 0.0) break;
    x = next;
  }
  EXPECT_EQ(control.active(), 0);
}

TEST(PassivityControl, takes_back_within_one_period_what_was_given_too_much) {
  PassivityControl control(settings(1e9));
  control.observe({{1, 0, 0}, {0, 0, 0}}, {0.5, 0, 0}, Vec3::Zero());
  ASSERT_NEAR(control.energy_Nmm(), -0.5, 1e-12);
  const Twist twist{{30, 40, 0}, {0, 0, 1}};
  const Wrench sent = control.control({}, twist, kT);
  control.observe(sent, kT * twist.velocity, kT * twist.angular_velocity);
  EXPECT_NEAR(control.energy_Nmm(), 0.0, 1e-12);
  EXPECT_EQ(control.active(), 1);
  EXPECT_EQ(control.limited(), 0);
  EXPECT_LT(sent.force.dot(twist.velocity), 0.0);
  EXPECT_LT(sent.torque.dot(twist.angular_velocity), 0.0);
}

TEST(PassivityControl, adds_no_more_damping_than_the_device_bears_and_pays_later) {
  PassivityControl control(settings(0.01));
  control.observe({{1, 0, 0}, {0, 0, 0}}, {0.5, 0, 0}, Vec3::Zero());
  const Twist twist{{20, 0, 0}, {0, 0, 0}};
  int periods = 0;
  while (control.energy_Nmm() < -1e-12 && periods < 1000) {
    const Wrench sent = control.control({}, twist, kT);
    ASSERT_LE(-sent.force.x(), 0.01 * 20.0 + 1e-12);
    control.observe(sent, kT * twist.velocity, Vec3::Zero());
    ++periods;
  }
  EXPECT_EQ(periods, 125) << "0.5 N mm at 0.2 N and 20 mm/s";
  EXPECT_GE(control.limited(), 124);
}

TEST(PassivityControl, at_rest_or_when_only_watching_it_adds_nothing) {
  PassivityControl control(settings(1.0));
  control.observe({{1, 0, 0}, {0, 0, 0}}, {1, 0, 0}, Vec3::Zero());
  const Wrench w{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(control.control(w, {}, kT).force, w.force);
  PassivityControl watch(settings(0.0));
  watch.observe({{1, 0, 0}, {0, 0, 0}}, {1, 0, 0}, Vec3::Zero());
  EXPECT_EQ(watch.control(w, {{9, 9, 9}, {1, 1, 1}}, kT).force, w.force);
  EXPECT_EQ(watch.active(), 0);
}

TEST(PassivityControl, what_was_lost_long_ago_does_not_cover_what_happens_now) {
  PassivityControl control(settings(1.0));
  for (int k = 0; k < 1000; ++k) control.observe({{-5, 0, 0}, {0, 0, 0}}, {1, 0, 0}, Vec3::Zero());
  EXPECT_EQ(control.energy_Nmm(), 200.0);
}

TEST(PassivityControl, calms_a_wall_that_answers_three_periods_late) {
  EXPECT_GT(growth(0.0), 10.0) << "unstable as it is";
  EXPECT_LT(growth(0.1), 1.0);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hand_loops.hpp"

#include "stylet/sim/simulation.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace stylet::validate {

namespace {

constexpr double kWay_mm = 2.0;
constexpr double kLever_rad = 2.0 * std::numbers::pi / 180.0;
constexpr double kRoll_rad = 60.0 * std::numbers::pi / 180.0;
constexpr double kLargest = 2.0, kSmallest = 0.02;  // range of HandLoop::size()

/// Uniform in [0, 1). The distributions of the standard library are not used, because they differ between machines.
double uniform(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

/// Moves a needle and sums the work of the hand.
class Hand {
 public:
  explicit Hand(const std::shared_ptr<const Model>& model) : model_(model), simulation_(model) {
    const PlannedInsertion& plan = model->insertions().front();
    base_ = along(-1.0);
    simulation_.place(base_, plan.entry, plan.direction);
  }

  void go_in(double depth_mm) {
    constexpr double speed_mm_per_s = 20.0, dt_s = 1e-3;
    const auto count = std::lround((depth_mm + 1.0) / (speed_mm_per_s * dt_s));
    for (long k = 1; k <= count; ++k)
      step(along(-1.0 + (depth_mm + 1.0) * static_cast<double>(k) / static_cast<double>(count)), dt_s);
  }

  void pass(const HandLoop& loop, const Pose& start, int steps) {
    const double stored = energy();
    work_ = {};
    for (int k = 1; k <= steps; ++k) step(loop.at(start, static_cast<double>(k) / steps), loop.duration_s() / steps);
    work_.stored = energy() - stored;
    work_.flags = flags_;
  }

  [[nodiscard]] const Pose& base() const { return base_; }
  [[nodiscard]] const HandWork& work() const { return work_; }

 private:
  [[nodiscard]] Pose along(double depth_mm) const {
    const PlannedInsertion& plan = model_->insertions().front();
    return pose_along(plan.entry + (depth_mm - model_->scenario().needle.length_mm) * plan.direction, plan.direction);
  }

  [[nodiscard]] double energy() const {
    return simulation_.insertion().tissue_energy() + simulation_.insertion().needle().energy();
  }

  void step(const Pose& next, double dt_s) {
    simulation_.prepare();
    const Step before = simulation_.last_step();
    const Step& report = simulation_.step(next, dt_s);
    const double work = work_of_hand(before, report);
    work_.net += work;
    work_.put_in += std::max(0.0, work);
    flags_ |= report.flags;
    base_ = next;
  }

  std::shared_ptr<const Model> model_;
  Simulation simulation_;
  Pose base_;
  HandWork work_;
  unsigned flags_ = 0;
};

}  // namespace

double work_of_hand(const Step& before, const Step& after) {
  const Eigen::AngleAxisd turn(after.base.rotation * before.base.rotation.conjugate());
  const double angle = std::remainder(turn.angle(), 2.0 * std::numbers::pi);
  return 0.5 * (before.hand_force_N + after.hand_force_N).dot(after.base.origin - before.base.origin) +
         0.5 * (before.torque_Nmm + after.torque_Nmm).dot(angle * turn.axis());
}

HandLoop::HandLoop(unsigned number) {
  std::mt19937 random(number + 1);
  random.discard(100);
  depth_mm_ = 20.0 + 35.0 * uniform(random);
  duration_s_ = 0.5 * std::pow(8.0, uniform(random));
  size_ = kLargest * std::pow(kSmallest / kLargest, uniform(random));
  for (auto& waves : waves_) {
    // Some loops move mainly in one direction, others in all directions at once.
    const double share = uniform(random);
    for (std::size_t h = 0; h < kHarmonics; ++h)
      waves[h] = {size_ * share / static_cast<double>(h + 1), 2.0 * std::numbers::pi * uniform(random)};
  }
}

Pose HandLoop::at(const Pose& start, double share) const {
  std::array<double, 6> q{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    for (std::size_t h = 0; h < kHarmonics; ++h) {
      const Wave& wave = waves_[i][h];
      const double turns = 2.0 * std::numbers::pi * static_cast<double>(h + 1) * share;
      q[i] += wave.amplitude * (std::sin(turns + wave.phase) - std::sin(wave.phase));
    }
  }
  Pose pose = start;
  if (share >= 1.0) return pose;  // the loop closes exactly
  pose.origin += start.rotation * Vec3(kWay_mm * Vec3(q[0], q[1], q[2]));
  const Vec3 lever = kLever_rad * Vec3(q[3], q[4], 0.0);
  const double tilt = lever.norm();
  pose.rotation = start.rotation * Eigen::AngleAxisd(tilt, tilt > 0.0 ? Vec3(lever / tilt) : Vec3::UnitX()) *
                  Eigen::AngleAxisd(kRoll_rad * q[5], Vec3::UnitZ());
  return pose;
}

HandWork pass_loop(const std::shared_ptr<const Model>& model, const HandLoop& loop, int passages, int steps) {
  Hand hand(model);
  hand.go_in(loop.depth_mm());
  const Pose start = hand.base();
  for (int k = 0; k < passages; ++k) hand.pass(loop, start, steps);
  return hand.work();
}

}  // namespace stylet::validate

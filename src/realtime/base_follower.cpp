// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/base_follower.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace stylet {

namespace {

Vec3 limited(const Vec3& v, double most) {
  const double length = v.stableNorm();
  return length > most ? Vec3(v * (most / length)) : v;
}

}  // namespace

BaseFollower::BaseFollower(const Limits& limits, const VirtualCoupling& coupling)
    : limits_(limits), coupled_(true), lever_(coupling.lever_mm()) {
  const VirtualCouplingSettings& s = coupling.settings();
  K_.setConstant(s.stiffness_N_per_mm);  // the lever makes the stiffnesses of translation and rotation equal
  B_.head<3>().setConstant(s.damping_N_s_per_mm);
  B_.tail<3>().setConstant(s.damping_Nmm_s_per_rad / (lever_ * lever_));
}

void BaseFollower::start(const Pose& base) {
  base_ = base;
  seen_.reset();
  force_.setZero();
  hold();
}

void BaseFollower::hold() {
  twist_ = {};
  moved_.setZero();
  first_ = true;
}

BaseFollower::Vec6 BaseFollower::offset(const Pose& device) const {
  Vec6 e;
  e << device.origin - base_.origin, lever_ * rotation_between(base_.rotation, device.rotation);
  return e;
}

void BaseFollower::move(const Vec6& by, double dt) {
  const Vec3 shift = limited(by.head<3>(), limits_.speed_mm_per_s * dt);
  const Vec3 turn = limited(by.tail<3>() / lever_, limits_.turn_rad_per_s * dt);
  base_.origin += shift;
  base_.rotation = rotated(base_.rotation, turn);
  moved_ << shift, lever_ * turn;
  twist_ = {shift / dt, turn / dt};
}

const Pose& BaseFollower::follow(const Pose& device, const Wrench& hand, double dt) {
  Vec6 e = offset(device);
  if (!coupled_) {
    move(e, dt);
    return base_;
  }
  Vec6 force = force_;
  if (hand.finite()) force << hand.force, hand.torque / lever_;
  if (first_) {
    before_ = e;  // assumes that the handle was at rest
    seen_.begin();
    first_ = false;
  } else {
    seen_.learn(moved_, force - force_, K_[0]);
  }
  force_ = force;
  const Vec6 damping = B_ / dt;
  SeenStiffness::Mat6 stiffness = seen_.S();
  stiffness.diagonal() += K_ + damping;
  const Vec6 unbalanced = K_.cwiseProduct(e) + damping.cwiseProduct(e - before_) - force;
  Vec6 by = stiffness.ldlt().solve(unbalanced + seen_.S() * seen_.sliding());
  if (!by.allFinite()) {  // the forces were too large
    seen_.reset();
    by.setZero();
  }
  move(by, dt);
  before_ = offset(device);
  return base_;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/base_follower.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace stylet {

namespace {

/// Share by which S approaches the stiffness of a softer body per step. It decreases from 1000 N/mm of bone to nothing
/// within 40 steps, but is kept while friction alternates between sticking and sliding.
constexpr double kShrink = 0.2;
/// [mm] Smaller motions are ignored, since they give no information about stiffness.
constexpr double kStill_mm = 1e-9;
/// If a body is stiffer than S by more than this factor (at 2 the step would become unstable), S takes its stiffness in
/// all directions.
constexpr double kSurprise = 1.5;
/// A motion that changes by less than this share is steady.
constexpr double kUneven = 0.02;
/// Stiffness below this share of the coupling's is negligible.
constexpr double kNegligible = 1e-9;
/// [N/mm] Upper bound of S; a body of this stiffness does not move.
constexpr double kStiffest = 1e6;

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
  S_.setZero();
  force_.setZero();
  hold();
}

void BaseFollower::hold() {
  twist_ = {};
  moved_.setZero();
  continued_.setZero();
  first_ = true;
}

BaseFollower::Vec6 BaseFollower::offset(const Pose& device) const {
  Vec6 e;
  e << device.origin - base_.origin, lever_ * rotation_between(base_.rotation, device.rotation);
  return e;
}

/// If motion s and change of force y show a much stiffer body than S, sets S to that stiffness in all directions.
/// @return whether it did
bool BaseFollower::stiffen(const Vec6& s, const Vec6& y) {
  const double sy = s.dot(y);
  if (sy <= std::max(kSurprise * s.dot(S_ * s), kNegligible * K_[0] * s.squaredNorm())) return false;
  S_ = std::min(y.squaredNorm() / sy, kStiffest) * Mat6::Identity();
  return true;
}

void BaseFollower::learn(const Vec6& y) {
  const Vec6 ds = moved_ - moved_before_;
  const Vec6 dy = y - change_;
  change_ = y;
  continued_.setZero();
  if (moved_.norm() < kStill_mm) return;
  // While the body slides, the total motion shows a low stiffness, but differences between steps show the real one.
  const bool stiffer = stiffen(moved_, y) || (ds.norm() > kUneven * moved_.norm() && stiffen(ds, dy));
  // Work below this is negligible against the coupling; without the limit a shrinking S would lead to division by zero.
  const double nothing = kNegligible * K_[0] * moved_.squaredNorm();
  const double sy = moved_.dot(y);
  const Vec6 Ss = S_ * moved_;
  const double sSs = moved_.dot(Ss);
  const double sliding = sSs > nothing ? std::clamp(1.0 - sy / sSs, 0.0, 1.0) : 0.0;
  if (!stiffer) {
    const double share = sy > sSs ? 1.0 : kShrink;
    if (sy > nothing) S_.noalias() += share * std::min(1.0 / sy, kStiffest / y.squaredNorm()) * y * y.transpose();
    if (sSs > nothing) S_.noalias() -= share / sSs * Ss * Ss.transpose();
  }
  continued_ = sliding * moved_;
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
    change_.setZero();
    first_ = false;
  } else {
    learn(force - force_);
  }
  force_ = force;
  const Vec6 damping = B_ / dt;
  Mat6 stiffness = S_;
  stiffness.diagonal() += K_ + damping;
  const Vec6 unbalanced = K_.cwiseProduct(e) + damping.cwiseProduct(e - before_) - force;
  Vec6 by = stiffness.ldlt().solve(unbalanced + S_ * continued_);
  moved_before_ = moved_;
  if (!by.allFinite()) {  // the forces were too large
    S_.setZero();
    by.setZero();
  }
  move(by, dt);
  before_ = offset(device);
  return base_;
}

}  // namespace stylet

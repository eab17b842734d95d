// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/predictor.hpp"

#include <cmath>

namespace stylet {

namespace {

/// [mm] A base that moves less than this in a sub-step counts as at rest. Raised, slow motions are not predicted.
constexpr double kBaseStill_mm = 1e-6;
/// Largest factor from the last slides and cut to the predicted ones. Raised, a hand that speeds up is followed
/// further, and a tremor may send contacts astray.
constexpr double kMostFurther = 4.0;
/// Largest factor from the last changes of forces and shape to the predicted ones. Raised, the same.
constexpr double kMostShare = 2.0;
/// Forces are predicted while less than this part of the base's motion is in a new direction. Raised, they are also
/// predicted through turns, where they change in other ways.
constexpr double kMostUnlike = 0.5;

Eigen::Vector<double, 6> motion(const Pose& from, const Pose& to, double length) {
  const Eigen::Quaterniond turn = to.rotation * from.rotation.conjugate();
  const double sign = turn.w() < 0.0 ? -1.0 : 1.0;  // q and −q are the same rotation
  Eigen::Vector<double, 6> result;
  result << to.origin - from.origin, 2.0 * sign * length * turn.vec();
  return result;
}

/// way + more, or `way` where the sum would have the other sign.
double further(double way, double more) { return (way + more) * way > 0.0 ? way + more : way; }

}  // namespace

Predictor::Predictor(Eigen::Index shape_size)
    : shape_start_(VecX::Zero(shape_size)),
      shape_gained_(shape_start_),
      shape_more_(shape_start_),
      expected_(shape_start_) {}

void Predictor::begin(const Pose& before, const Pose& now, const Needle& needle, TipContact& tip,
                      std::span<ShaftContact> shaft) {
  shape_start_ = needle.state();
  tip_start_ = needle.point(needle.length());
  tip.history.start = tip.force;

  for (ShaftContact& contact : shaft) {
    contact.s_start = contact.s;
    contact.state_start = contact.state;
    contact.fast_start = contact.fast;
    contact.history.start = contact.force;
  }

  const bool force_trend_known = expects_forces() && steady_;
  const bool way_trend_known = way_.share > 0.0 && steady_;
  force_ = way_ = {};
  const Eigen::Vector<double, 6> moves = motion(before, now, needle.length());
  const Eigen::Vector<double, 6> moved = last_motion_;
  last_motion_ = moves;
  if (steady_ && moves.norm() > kBaseStill_mm && moved.norm() > kBaseStill_mm) {
    const double share = moves.dot(moved) / moved.squaredNorm();
    if (share > 0.0 && share < kMostShare && (moves - share * moved).norm() < kMostUnlike * moves.norm())
      force_.share = share;
  }
  if (force_trend_known) force_.trend = force_.share;

  const double way = (now.origin - before.origin).dot(now.rotation * Vec3::UnitZ());
  const double way_before = last_way_;
  last_way_ = way;
  if (!(std::abs(way) > kBaseStill_mm && std::abs(way_before) > kBaseStill_mm)) return;
  const double share = way / way_before;
  if (!(share > 0.0 && share < kMostFurther)) return;
  way_.share = share;
  if (way_trend_known) way_.trend = share;
  for (ShaftContact& contact : shaft) {
    if (!contact.sticks())
      contact.s = contact.s_start + further(way_.share * contact.slid, way_.trend * contact.slid_more);
  }
}

void Predictor::go_on(Needle& needle, TipContact& tip, std::span<ShaftContact> shaft) {
  const double cut = further(way_.share * last_cut_, way_.trend * cut_more_);
  if (cut > 0.0 && tip.cuts()) tip.cut.march_before_surface(cut);
  if (!expects_forces()) return;
  expected_.noalias() = shape_start_ + force_.share * shape_gained_ + force_.trend * shape_more_;
  needle.set_state(expected_);
  if (tip.holds()) tip.force += tip.history.expected(force_);
  for (ShaftContact& contact : shaft) contact.force += contact.history.expected(force_);
}

void Predictor::go_back(Needle& needle, TipContact& tip, std::span<ShaftContact> shaft) const {
  needle.set_state(shape_start_);
  if (tip.touches() && !tip.holds() && !tip.history.start.isZero(0.0)) tip.set_state(TipContact::State::stick);
  tip.force = tip.holds() ? tip.history.start : Vec3::Zero();
  for (ShaftContact& contact : shaft) {
    contact.s = contact.s_start;
    contact.state = contact.state_start;
    contact.fast = contact.fast_start;
    contact.force = contact.history.start;
  }
  tip.take_back_cut();
}

void Predictor::end(double cut, bool steady, const Needle& needle, TipContact& tip, std::span<ShaftContact> shaft) {
  steady_ = steady;
  shape_more_.noalias() = needle.state() - shape_start_ - force_.share * shape_gained_;
  shape_gained_ = needle.state() - shape_start_;
  tip.history.more = tip.force - tip.history.start - force_.share * tip.history.gained;
  tip.history.gained = tip.force - tip.history.start;
  cut_more_ = cut - way_.share * last_cut_;
  last_cut_ = cut;
  for (ShaftContact& contact : shaft) {
    const double slid = contact.s - contact.s_start;
    const Vec3 gained = contact.force - contact.history.start;
    // A contact that is new, or has just begun to slide or to stick, cannot be extrapolated.
    const bool paced = contact.toggles == 0 && !contact.history.gained.isZero(0.0);
    contact.slid_more = paced && contact.slid != 0.0 ? slid - way_.share * contact.slid : 0.0;
    contact.slid = slid;
    contact.history.more = paced ? Vec3(gained - force_.share * contact.history.gained) : Vec3::Zero();
    contact.history.gained = gained;
  }
}

void Predictor::forget() {
  last_way_ = last_cut_ = cut_more_ = 0.0;
  force_.share = way_.share = 0.0;
  last_motion_.setZero();
}

}  // namespace stylet

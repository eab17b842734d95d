// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <cmath>

/// Where a sub-step will probably end: everything goes on as in the last one, in proportion to the base's motion, and
/// changes its pace as it did then. What the balance is solved from changes nothing of what it is, but from there the
/// solver has only third differences to find (docs/theory/coupling.md §4).
namespace stylet {

namespace {

constexpr double kBaseStill_mm = 1e-6;  ///< a base that moves less in a sub-step stands still
/// Times as far as before are slides and cuts expected to go, …
constexpr double kMostFurther = 4.0;
constexpr double kMostShare = 2.0;   ///< … forces and shape, …
constexpr double kMostUnlike = 0.5;  ///< … and those only where less than this part of the base's motion is a new one

/// Motion of a base [mm]: of its origin, and of a point so far from it as the needle is long by its turn.
Eigen::Vector<double, 6> motion(const Pose& from, const Pose& to, double length) {
  const Eigen::Quaterniond turn = to.rotation * from.rotation.conjugate();
  const double sign = turn.w() < 0.0 ? -1.0 : 1.0;  // one turn is two quaternions
  Eigen::Vector<double, 6> result;
  result << to.origin - from.origin, 2.0 * sign * length * turn.vec();
  return result;
}

/// A way, and more of it as long as that does not turn it round.
double further(double way, double more) { return (way + more) * way > 0.0 ? way + more : way; }

}  // namespace

void Insertion::Parts::keep_start() {
  shape_start = needle->state();
  tip_start = needle->point(length());
  tip.force_start = tip.force;
  for (Grip& grip : grips) {
    grip.s_start = grip.s;
    grip.force_start = grip.force;
  }
}

void Insertion::Parts::expect(const Pose& from, const Pose& to) {
  const bool force_trend_known = force_share > 0.0 && steady;
  const bool way_trend_known = way_share > 0.0 && steady;
  going_on = true;
  force_share = force_trend = way_share = way_trend = 0.0;
  const Eigen::Vector<double, 6> now = motion(from, to, length());
  const Eigen::Vector<double, 6> before = last_motion;
  last_motion = now;
  preparation.worn_mm += now.norm();
  if (steady && now.norm() > kBaseStill_mm && before.norm() > kBaseStill_mm) {
    const double share = now.dot(before) / before.squaredNorm();
    if (share > 0.0 && share < kMostShare && (now - share * before).norm() < kMostUnlike * now.norm())
      force_share = share;
  }
  if (force_trend_known) force_trend = force_share;

  const double way = (to.origin - from.origin).dot(to.rotation * Vec3::UnitZ());
  const double way_before = last_way;
  last_way = way;
  if (!(std::abs(way) > kBaseStill_mm && std::abs(way_before) > kBaseStill_mm)) return;
  const double share = way / way_before;
  if (!(share > 0.0 && share < kMostFurther)) return;
  way_share = share;
  if (way_trend_known) way_trend = share;
  for (Grip& grip : grips) {
    if (grip.state != Grip::State::stick)
      grip.s = grip.s_start + further(way_share * grip.slid, way_trend * grip.slid_more);
  }
}

void Insertion::Parts::go_on() {
  const double cut = further(way_share * last_cut, way_trend * cut_more);
  if (cut > 0.0 && tip.touching && tip.state == Tip::State::cut) {
    march(cut);
    if (tip.blocked) march(0.0);  // left to the balance
    tip.blocked = false;
  }
  if (force_share == 0.0) return;
  VecX& expected = kept.needle;  // no iterate is kept yet
  expected.noalias() = shape_start + force_share * shape_gained + force_trend * shape_more;
  needle->set_state(expected);
  if (tip_holds()) tip.force += force_share * tip.gained + force_trend * tip.gained_more;
  for (Grip& grip : grips) grip.force += force_share * grip.gained + force_trend * grip.gained_more;
}

void Insertion::Parts::stay() {
  needle->set_state(shape_start);
  if (tip.touching && tip.state == Tip::State::open && !tip.force_start.isZero(0.0)) tip.state = Tip::State::stick;
  tip.force = tip_holds() ? tip.force_start : Vec3::Zero();
  for (Grip& grip : grips) {
    grip.s = grip.s_start;
    grip.force = grip.force_start;
  }
  take_back_cut();
}

void Insertion::Parts::keep_gains(double cut) {
  shape_more.noalias() = needle->state() - shape_start - force_share * shape_gained;
  shape_gained = needle->state() - shape_start;
  tip.gained_more = tip.force - tip.force_start - force_share * tip.gained;
  tip.gained = tip.force - tip.force_start;
  cut_more = cut - way_share * last_cut;
  last_cut = cut;
  for (Grip& grip : grips) {
    const double slid = grip.s - grip.s_start;
    const Vec3 gained = grip.force - grip.force_start;
    // A contact that is new, or has just come to slide or to hold, has no pace yet.
    const bool paced = grip.toggles == 0 && !grip.gained.isZero(0.0);
    grip.slid_more = paced && grip.slid != 0.0 ? slid - way_share * grip.slid : 0.0;
    grip.slid = slid;
    grip.gained_more = paced ? Vec3(gained - force_share * grip.gained) : Vec3::Zero();
    grip.gained = gained;
  }
}

}  // namespace stylet

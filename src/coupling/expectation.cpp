// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <cmath>

/// Where a sub-step will probably end: everything goes on as in the last one, in proportion to the base's motion. What
/// the balance is solved from changes nothing of what it is, but from there the solver has only second differences to
/// find (docs/theory/coupling.md §4).
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

}  // namespace

void Insertion::Parts::keep_start() {
  shape_start = needle->state();
  tip.force_start = tip.force;
  for (Grip& grip : grips) {
    grip.s_start = grip.s;
    grip.force_start = grip.force;
  }
}

void Insertion::Parts::expect(const Pose& from, const Pose& to) {
  expected_cut = expected_share = 0.0;
  const Eigen::Vector<double, 6> now = motion(from, to, length());
  const Eigen::Vector<double, 6> before = last_motion;
  last_motion = now;
  const double way = (to.origin - from.origin).dot(to.rotation * Vec3::UnitZ());
  const double way_before = last_way;
  last_way = way;
  if (std::abs(way) > kBaseStill_mm && std::abs(way_before) > kBaseStill_mm) {
    const double share = way / way_before;
    if (share > 0.0 && share < kMostFurther) {
      expected_cut = share * last_cut;
      for (Grip& grip : grips) {
        if (grip.state != Grip::State::stick) grip.s = grip.s_start + share * grip.slid;
      }
    }
  }
  if (!steady || !(now.norm() > kBaseStill_mm && before.norm() > kBaseStill_mm)) return;
  const double share = now.dot(before) / before.squaredNorm();
  if (share > 0.0 && share < kMostShare && (now - share * before).norm() < kMostUnlike * now.norm())
    expected_share = share;
}

void Insertion::Parts::go_on() {
  if (expected_cut > 0.0 && tip.touching && tip.state == Tip::State::cut) {
    march(expected_cut);
    if (tip.blocked) march(0.0);  // left to the balance
    tip.blocked = false;
  }
  if (expected_share == 0.0) return;
  VecX& expected = kept.needle;  // no iterate is kept yet
  expected.noalias() = shape_start + expected_share * shape_gained;
  needle->set_state(expected);
  if (tip.touching && tip.state != Tip::State::open) tip.force += expected_share * tip.gained;
  for (Grip& grip : grips) grip.force += expected_share * grip.gained;
}

void Insertion::Parts::stay() {
  needle->set_state(shape_start);
  tip.force = tip.touching && tip.state != Tip::State::open ? tip.force_start : Vec3::Zero();
  for (Grip& grip : grips) {
    grip.s = grip.s_start;
    grip.force = grip.force_start;
  }
  if (tip.touching && tip.state == Tip::State::cut) march(0.0);
}

void Insertion::Parts::keep_gains() {
  shape_gained = needle->state() - shape_start;
  tip.gained = tip.force - tip.force_start;
  for (Grip& grip : grips) {
    grip.slid = grip.s - grip.s_start;
    grip.gained = grip.force - grip.force_start;
  }
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

/// Where a sub-step will probably end: everything goes on as in the last one, in proportion to the base's way. What the
/// balance is solved from changes nothing of what it is, but from there the solver has only second differences to find
/// (docs/theory/coupling.md §4).
namespace stylet {

void Insertion::Parts::keep_start() {
  shape_start = needle->state();
  tip.force_start = tip.force;
  for (Grip& grip : grips) {
    grip.s_start = grip.s;
    grip.force_start = grip.force;
  }
}

void Insertion::Parts::expect(const Pose& from, const Pose& to) {
  constexpr double most = 4.0;  // times as far as before
  const double way = (to.origin - from.origin).dot(to.rotation * Vec3::UnitZ());
  const double share = last_way != 0.0 ? way / last_way : 0.0;
  last_way = way;
  expected_cut = expected_share = 0.0;
  if (!(share > 0.0 && share < most)) return;
  expected_cut = share * last_cut;
  if (steady) expected_share = share;
  for (Grip& grip : grips) {
    if (grip.state != Grip::State::stick) grip.s = grip.s_start + share * grip.slid;
  }
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

void Insertion::Parts::keep_gains() {
  shape_gained = needle->state() - shape_start;
  tip.gained = tip.force - tip.force_start;
  for (Grip& grip : grips) {
    grip.slid = grip.s - grip.s_start;
    grip.gained = grip.force - grip.force_start;
  }
}

}  // namespace stylet

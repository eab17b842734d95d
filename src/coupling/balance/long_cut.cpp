// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/long_cut.hpp"

#include <utility>

namespace stylet {

namespace {
/// [mm] A cut that is longer than this in a sub-step is aimed anew; the base moves no further in a sub-step by default,
/// so that only cuts faster than the base are. Raised, tracks depend more on the time step; lowered, more balances are
/// sought twice.
constexpr double kLong_mm = 0.25;
/// [mm] A cut whose end would move by less is left as it was aimed. Raised, tracks depend more on the time step.
constexpr double kApart_mm = 0.05;

/// Exchanges the present forces and those at the start of the sub-step.
void swap_forces(const Contacts& contacts) {
  std::swap(contacts.tip.force, contacts.tip.history.start);
  for (ShaftContact& contact : contacts.grips()) std::swap(contact.force, contact.history.start);
}

/// The displacement gradient at the tip's present place.
Mat3 gradient(const Contacts& contacts) {
  return contacts.tissue.compliance().gradient_at_tip(contacts.tissue.all_forces(contacts.forces()));
}

/// The same under the mean of the forces at the start of the sub-step and of the present ones.
Mat3 gradient_by_mean(const Contacts& contacts) {
  const Mat3 now = gradient(contacts);
  swap_forces(contacts);
  const Mat3 at_start = gradient(contacts);
  swap_forces(contacts);
  return 0.5 * (at_start + now);
}
}  // namespace

/// The mean follows Simpson's rule, with the direction at the start, in the middle and at the end of the cut. The
/// forces fall in proportion to the length of cut, so in the middle they are the mean of those at both ends.
bool aim_long_cut(const Contacts& contacts) {
  TipContact& tip = contacts.tip;
  if (!tip.cuts() && !tip.cut.is_blocked()) return false;
  const double length = tip.cut.advance();
  if (length <= kLong_mm) return false;
  const Cut::Aim& first = tip.cut.first_aim();
  const Cut::Aim last = tip.aim_here(contacts.forces());
  tip.cut.march(0.5 * length);
  const Vec3 middle = tip.undeformed(0.5 * (first.along + last.along), gradient_by_mean(contacts));
  const Vec3 mean = (first.direction + 4.0 * middle + last.direction).normalized();
  if (length * (mean - first.direction).norm() < kApart_mm) {
    tip.cut.march(length);
    return false;
  }
  tip.cut.turn(mean, length);
  tip.set_state(TipContact::State::cut);
  return true;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/contact_states.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// [mm] A contact that stands for less length carries no friction. Raised, contacts next to the tip start to hold
/// later.
constexpr double kNoLength_mm = 1e-6;
/// [mm] Smaller motions are rounding, not sliding. Raised, a contact may slide the wrong way by this much.
constexpr double kStill_mm = 1e-9;
/// [mm] Tolerance on the way at the speed where friction stops growing: there the laws for slow and fast sliding agree,
/// and rounding decides the side. Raised, the friction near that speed is less exact.
constexpr double kSameSpeed_mm = 1e-6;
}  // namespace

void ContactStates::begin(int most_toggles) {
  most_toggles_ = most_toggles;
  for (ShaftContact& contact : contacts_.grips()) contact.toggles = 0;
  contacts_.tip.toggles = 0;
}

bool ContactStates::is_frictionless(const ShaftContact& contact) { return contact.length < kNoLength_mm; }

double ContactStates::contradiction(int load, const Trial& trial) const {
  if (load == 0) return contradiction_of_tip(trial);
  const ShaftContact& contact = contacts_.of_shaft(load);
  if (contact.toggles > most_toggles_ || is_frictionless(contact)) return 0.0;
  if (contact.presses_only && contact.state == ShaftContact::State::backward) return 0.0;
  const double most = contact.law.static_N_per_mm * contact.length;
  if (contact.sticks()) return contact.presses_only && trial.axial < 0.0 ? -trial.axial : std::abs(trial.axial) - most;
  // The contact slides against the sense of its state, or faster or slower than its state allows. The way decides,
  // because forces hardly differ where friction does not depend on speed; it is converted to the force that displaces
  // the tissue by this way.
  const double slides = trial.slides;
  const double wrong =
      contact.fast ? contact.reach - slides - kSameSpeed_mm : std::max(-slides, slides - contact.reach - kSameSpeed_mm);
  if (wrong <= kStill_mm) return 0.0;
  const TissueResponse& tissue = contacts_.tissue;
  return 3.0 * wrong / tissue.compliance()(contact.point, contact.point).trace();
}

/// A surface ahead is broken by a balance only (TipContact::breaks_surface), so it is no contradiction here.
double ContactStates::contradiction_of_tip(const Trial& trial) const {
  const TipContact& tip = contacts_.tip;
  if (!tip.touches() || tip.toggles > most_toggles_) return 0.0;
  switch (tip.state()) {
    case TipContact::State::open:
      return trial.opening;
    case TipContact::State::stick: {
      const bool held = tip.cut.is_blocked() || tip.cut.ends_leg() || tip.ahead.is_surface();
      return std::max(-trial.axial, held ? 0.0 : trial.axial - tip.ahead.limit());
    }
    case TipContact::State::cut:
      return tip.cut.advance() > 0.0 ? 0.0 : tip.ahead.cutting() - trial.axial;
  }
  return 0.0;
}

void ContactStates::change(int load, const Trial& trial, Step& step) {
  ++step.pivots;
  int& toggles = load == 0 ? contacts_.tip.toggles : contacts_.of_shaft(load).toggles;
  if (++toggles > most_toggles_) step.flags |= Step::contact_cycling;
  if (load == 0) {
    change_tip(trial);
    return;
  }
  ShaftContact& contact = contacts_.of_shaft(load);
  if (contact.sticks()) {
    contact.state = trial.axial > 0.0 ? ShaftContact::State::forward : ShaftContact::State::backward;
    contact.fast = false;
  } else if (contact.fast || trial.slides > contact.reach) {
    contact.fast = !contact.fast;
  } else {
    contact.state = ShaftContact::State::stick;
    contact.s = contact.s_start;  // the place at which it was held
  }
}

void ContactStates::stick_where_slow(std::span<ShaftContact> contacts, double h, double zero_band_mm_per_s) {
  for (ShaftContact& contact : contacts) {
    if (std::abs(contact.slid) / h < zero_band_mm_per_s) contact.state = ShaftContact::State::stick;
  }
}

void ContactStates::change_tip(const Trial& trial) {
  TipContact& tip = contacts_.tip;
  if (tip.state() != TipContact::State::stick) {
    tip.set_state(TipContact::State::stick);
  } else {
    tip.set_state(trial.axial < 0.0 ? TipContact::State::open : TipContact::State::cut);
  }
}

}  // namespace stylet

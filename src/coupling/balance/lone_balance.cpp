// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/lone_balance.hpp"

namespace stylet {

namespace {
/// How often the needle is balanced in a sub-step before all needles are balanced together. Raised, sub-steps in which
/// contacts at rest change their states take longer.
constexpr int kMostBalances = 4;

Contacts alone(const BalanceParts& all, Needle& needle) {
  return {needle, all.contacts.tissue, all.contacts.tip, all.contacts.shaft, nullptr, true};
}
}  // namespace

LoneBalance::LoneBalance(const BalanceParts& all, CoupledBalance& whole, Needle& needle, int points)
    : whole_(whole),
      contacts_(alone(all, needle)),
      predictor_(needle.state().size()),
      balance_({.settings = all.settings,
                .contacts = contacts_,
                .path = all.path,
                .hand = all.hand,
                .predictor = predictor_,
                .most_contacts = all.settings.capacity}),
      hold_(all.contacts, whole, all.settings.capacity + 1, points) {}

/// Balances the needle until those at rest have followed.
bool LoneBalance::find(double h, Step& step) {
  TissueResponse& tissue = contacts_.tissue;
  for (int balances = 1; balances <= kMostBalances; ++balances) {
    Effort effort(contacts_.count());
    tissue.hold_by(&hold_, hold_.points(), hold_.free_points());
    steady_ = balance_.solve(h, effort, step);
    tissue.hold_by(nullptr);
    if ((step.flags & (Step::not_converged | Step::contact_cycling)) != 0) return false;
    const auto followed = hold_.follow();
    if (followed == RestingHold::Followed::done) return true;
    if (followed == RestingHold::Followed::no) return false;
    predictor_.go_back(contacts_.needle, contacts_.tip, contacts_.grips());
    if (!hold_.start_again(step)) return false;
  }
  return false;
}

bool LoneBalance::solve(const Pose& from, const Pose& to, double h, double damping, Step& step) {
  if (!hold_.begin(h)) return false;
  if (!std::exchange(was_last_, true)) {
    balance_.forget_tangent();
    whole_.forget_tangent();
    predictor_.interrupt();
  }
  balance_.damp(damping);
  balance_.begin();
  predictor_.begin(from, to, contacts_.needle, contacts_.tip, contacts_.grips());
  balance_.base_moved(predictor_.last_motion());
  const unsigned flags_before = std::exchange(step.flags, 0u);
  const bool found = find(h, step);
  if (!found) {
    predictor_.go_back(contacts_.needle, contacts_.tip, contacts_.grips());
    predictor_.interrupt();
    hold_.take_back();
    step.flags = 0;
  }
  step.flags |= flags_before;
  return found;
}

void LoneBalance::end(double cut) { predictor_.end(cut, steady_, contacts_.needle, contacts_.tip, contacts_.grips()); }

}  // namespace stylet

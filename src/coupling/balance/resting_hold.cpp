// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_hold.hpp"

#include <algorithm>
#include <utility>

namespace stylet {

namespace {
/// Sub-steps from one look at all laws to the next. Raised, what linear equations leave over grows, with its square;
/// lowered, more sub-steps read the whole compliance among the contacts at rest.
constexpr int kWindow = 20;
/// [mm] Length of cut after which the next look is due.
constexpr double kLongestCut_mm = 1.0;
/// Sub-steps in which all contacts at rest are visited. Raised, the tip's effect on them is known less exactly, and so
/// is what the tissue remembers; lowered, a sub-step takes longer.
constexpr int kTurn = 8;
/// [N] Contradictions below this are rounding.
constexpr double kNoContradiction_N = 1e-12;
}  // namespace

RestingHold::RestingHold(const Contacts& all, CoupledBalance& whole, int most_own, int points)
    : all_(all),
      whole_(whole),
      kept_(all.shaft.others()),
      points_(resting(), points),
      own_(most_own, points),
      reach_(grips().count(), most_own),
      creep_(points, most_own),
      forces_(grips().count(), most_own),
      errors_(grips().count()) {
  contradicted_.reserve(kept_.size());
}

void RestingHold::balanced(double h, bool found) {
  h_ = found ? h : 0.0;
  reach_.forget();
  age_ = kWindow;  // the first sub-step of those that follow begins with a look
}

void RestingHold::settle() {
  write_all();
  all_.tissue.compliance().release_tip();
}

/// Computes the forces on all contacts at rest.
void RestingHold::write_all() {
  hide();
  if (!forces_.are_known()) return;
  forces_.follow(own_forces(), grips());
  forces_.compute(0, grips().count(), grips());
  const auto forces = forces_.computed(grips());
  forces_.forget();
  for (int grip = 0; grip < grips().count(); ++grip) take_force(grip, forces.segment<3>(3 * grip));
}

/// A contact at rest has this force [N]. The tissue remembers the force before for the sub-steps in between, in which
/// it has changed steadily.
void RestingHold::take_force(int grip, const Vec3& force) {
  Kept& kept = kept_[static_cast<std::size_t>(grip)];
  ShaftContact& contact = all_.of_shaft(grip + 1);
  const Vec3 more = force - contact.force;
  const Vec3 missed = 0.5 * std::max(0, kept.since - 1) * more;
  if (all_.tissue.memory().on()) {
    all_.tissue.make_up(contact.point, missed);
    if (forces_.are_known()) {
      const Vec3 remembered = (1.0 - all_.tissue.memory().kept()) * missed;
      creep_.change(all_.tissue.compliance(), own_.all(), contact.point, more, remembered);
      reach_.change(grip, more, remembered);
    }
  }
  contact.force = force;
  kept.since = 0;
}

void RestingHold::show() {
  if (!forces_.are_known() || std::exchange(shown_, true)) return;
  all_.tissue.compliance().release_tip();
  forces_.follow(own_forces(), grips());
  forces_.compute(0, grips().count(), grips());
  const auto forces = forces_.computed(grips());
  for (int grip = 0; grip < grips().count(); ++grip) {
    kept_[static_cast<std::size_t>(grip)].force =
        std::exchange(all_.force(grip + 1), Vec3(forces.segment<3>(3 * grip)));
  }
}

/// Takes back what show() has written.
void RestingHold::hide() {
  if (!std::exchange(shown_, false)) return;
  for (int grip = 0; grip < grips().count(); ++grip) all_.force(grip + 1) = kept_[static_cast<std::size_t>(grip)].force;
}

void RestingHold::keep() {
  const auto contacts = resting();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ShaftContact& contact = contacts[i];
    kept_[i] = {contact.force, contact.s, contact.state, contact.fast, kept_[i].since + 1};
    contact.s_start = contact.s;
    contact.state_start = contact.state;
    contact.fast_start = contact.fast;
    contact.slid = contact.slid_more = 0.0;
    contact.history = {};
  }
  whole_.begin_states();
}

void RestingHold::take_back() {
  settle();
  const auto contacts = resting();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].s = kept_[i].s;
    contacts[i].state = kept_[i].state;
    contacts[i].fast = kept_[i].fast;
  }
  errors_.clear();
  h_ = 0.0;
}

/// [mm] By how much the arc length of a contact on its needle becomes smaller in the sub-step under a force [N].
double RestingHold::slides(const ShaftContact& contact, int c, const Vec3& force) const {
  if (contact.sticks()) return 0.0;
  const Vec3& t = whole_.rows().frame[static_cast<std::size_t>(c)].col(2);
  return contact.sense() * ContactStates::way(contact, t.dot(force));
}

/// Looks at all laws at rest, and takes what linear equations need from there.
bool RestingHold::look(double h) {
  RestingMatrix& matrix = grips().matrix();
  auto solved = forces_.columns(matrix);
  const bool is_usual = age_ < kWindow;
  if (is_usual) {
    solved.col(1) = reach_.remember(all_, matrix);
  } else {
    solved.col(1).setZero();
  }
  if (!whole_.settle_rest(h)) return false;
  ++version_;
  age_ = 0;
  reach_.look(all_, matrix);
  creep_.look(all_, solved.col(0).head(matrix.contact_rows()));
  matrix.fill_springs(solved.col(0));
  matrix.solve(solved);
  return true;
}

/// Between looks: the forces at rest follow the creep of this sub-step, and contacts that slide begin at their present
/// places.
void RestingHold::go_on() {
  ++age_;
  forces_.creep(creep_.fades(all_.tissue.memory()));
  for (int c = 1; c < all_.first_own(); ++c) {
    const ShaftContact& contact = all_.of_shaft(c);
    if (const double mm = slides(contact, c, contact.force); mm != 0.0) forces_.slide(c - 1, mm, grips());
  }
}

/// Takes over the moved needle's contacts.
void RestingHold::take_contacts() {
  const auto own = std::as_const(all_.shaft).own();
  HeldTissue& held = grips().held();
  const std::size_t same = std::min(own_.same(own), static_cast<std::size_t>(held.known()) - 1);
  held.keep_first(static_cast<int>(same) + 1);
  for (const ShaftContact& contact : own.subspan(same)) {
    auto A = held.next(grips().matrix());
    for (int c = 1; c < all_.first_own(); ++c)
      A.middleRows<3>(3 * c - 3) = all_.tissue.own_compliance_now(all_.point(c), contact.point);
    held.add_next(grips().matrix(), grips().sliding());
    ++version_;
  }
  own_.take(own);
}

/// Takes the present forces as those from which changes are counted.
/// @param columns whether solved columns are new
void RestingHold::take_start(bool columns) {
  forces_.take(columns, all_, std::span(whole_.rows().frame).subspan(1), grips(), own_forces());
  reach_.take(columns, all_, grips(), forces_.reference(grips().matrix()));
  if (all_.tissue.memory().on()) creep_.take(all_, own_.all());
}

bool RestingHold::begin(double h) {
  hide();
  if (h != h_ || all_.tip.cut.is_stale()) {
    settle();
    return false;
  }
  const bool looks = !forces_.are_known() || age_ + 1 >= kWindow || reach_.cut(all_) > kLongestCut_mm ||
                     !reach_.is_at(all_.tip.cut.x());
  if (looks) settle();
  keep();
  whole_.rows().soften(all_, h_);
  const auto own = std::as_const(all_.shaft).own();
  const bool others = own.size() != own_.all().size() || own_.same(own) != own.size() ||
                      static_cast<std::size_t>(grips().held().known()) != own.size() + 1;
  const bool changes = looks || others || grips().differs();
  if (changes) write_all();
  const std::uint64_t before = grips().version();
  const bool fits = grips().follow();
  if (grips().version() != before) ++version_;
  if (!fits || (looks && !look(h))) {
    take_back();
    return false;
  }
  if (changes) {
    take_contacts();
    take_start(looks || others);
  }
  if (!looks) go_on();
  points_.take(all_.tissue.compliance().points());
  all_.tissue.compliance().restrict_tip(points_.free());
  begin_balance();
  return true;
}

/// The moved needle is at the start of the sub-step, to be balanced.
void RestingHold::begin_balance() {
  forces_.set_usual(reach_.begin(all_, grips()));
  forces_.begin(grips());
}

/// Looks at the laws of all contacts at rest. @param axial [N] (contacts at rest) forces along the needles
void RestingHold::look_at_laws(const Eigen::Ref<const VecX>& axial) {
  contradicted_.clear();
  for (int c = 1; c < all_.first_own(); ++c) {
    const ShaftContact& contact = all_.of_shaft(c);
    const double along = axial[c - 1];
    const ContactStates::Trial trial{.axial = along,
                                     .slides = contact.sticks() ? 0.0 : ContactStates::way(contact, along)};
    if (whole_.states().contradiction(c, trial) > kNoContradiction_N) contradicted_.push_back({c, trial});
  }
}

RestingHold::Followed RestingHold::follow() {
  look_at_laws(forces_.follow(own_forces(), grips()));
  if (!contradicted_.empty()) return Followed::again;
  const int count = grips().count();
  const int end = std::min(count, turn_ + (count + kTurn - 1) / kTurn);
  const auto is_visited = [&](int grip) { return (grip >= turn_ && grip < end) || !all_.of_shaft(grip + 1).sticks(); };
  forces_.compute(turn_, end, grips());
  for (int grip = 0; grip < count; ++grip) {
    if (is_visited(grip) && (grip < turn_ || grip >= end)) forces_.compute(grip, grip + 1, grips());
  }
  const auto forces = forces_.computed(grips());
  for (int grip = 0; grip < count; ++grip) {
    if (!is_visited(grip)) continue;
    ShaftContact& contact = all_.of_shaft(grip + 1);
    take_force(grip, forces.segment<3>(3 * grip));
    contact.s = contact.s_start - slides(contact, grip + 1, contact.force);
    contact.slid = contact.s - contact.s_start;
  }
  all_.tissue.compliance().renew_tip(points_.of(turn_, end));
  reach_.visit(all_, turn_, end, grips(), forces_.reference(grips().matrix()));
  turn_ = end < count ? end : 0;
  reach_.end(all_, all_.tissue.memory().kept());
  creep_.end(all_.tissue.memory().kept());
  return Followed::done;
}

bool RestingHold::start_again(Step& step) {
  write_all();
  for (const Contradicted& one : contradicted_) {
    const ShaftContact& contact = all_.of_shaft(one.contact);
    errors_.set(one.contact - 1, -slides(contact, one.contact, contact.force));
    whole_.states().change(one.contact, one.trial, step);
  }
  whole_.rows().soften(all_, h_);
  const std::uint64_t before = grips().version();
  if (!grips().follow()) return false;
  if (grips().version() != before) ++version_;
  for (const int grip : errors_.contacts()) {
    const ShaftContact& contact = all_.of_shaft(grip + 1);
    errors_.add(grip, slides(contact, grip + 1, contact.force));
  }
  const auto forces = errors_.answer(grips().matrix(), grips().sliding());
  for (int c = 1; c < all_.first_own(); ++c) all_.force(c) += forces.segment<3>(3 * c - 3);
  take_start(false);
  begin_balance();
  return true;
}

Mat3 RestingHold::reduction(int point, int other) const {
  return grips().held().reduction().block<3, 3>(own_.row(point), own_.row(other));
}

Vec3 RestingHold::displacement(int point) const {
  const Eigen::Index at = own_.row(point);
  Vec3 moved = forces_.motion(at) - reach_.felt(all_, at);
  const bool is_tip = point == ContactCompliance::kTip;
  if (is_tip) moved += reach_.at_tip(all_, own_forces(), forces_.own(grips().held()));
  const TissueMemory& memory = all_.tissue.memory();
  if (!memory.on()) return moved;
  return moved + memory.most() * memory.kept() * (is_tip ? reach_.remembered(all_) : creep_.remembered(at));
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): the result is written through its view
void RestingHold::write_forces(Eigen::Ref<MatX> forces) const {
  for (const ShaftContact& contact : resting()) forces.col(contact.point) = contact.force;
}

}  // namespace stylet

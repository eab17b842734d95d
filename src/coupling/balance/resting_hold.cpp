// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_hold.hpp"

namespace stylet {

namespace {
/// Sub-steps from one look at all laws to the next. Raised, what linear equations leave over grows, with its square;
/// lowered, more sub-steps read the whole compliance among the contacts at rest.
constexpr int kWindow = 10;
/// [N] Contradictions below this are rounding.
constexpr double kNoContradiction_N = 1e-12;
}  // namespace

RestingHold::RestingHold(const Contacts& all, CoupledBalance& whole, int most_own, int points)
    : all_(all),
      whole_(whole),
      kept_(all.shaft.others()),
      own_(most_own, points),
      start_(VecX::Zero(3 * static_cast<Eigen::Index>(most_own))),
      moved_(MatX::Zero(start_.size(), 3)),
      drift_(RestingMatrix::most_rows(grips().count())),
      creep_(points),
      solved_(MatX::Zero(RestingMatrix::most_rows(grips().count()), 2)),
      errors_(grips().count()),
      z_(solved_.col(0)),
      force_(z_) {}

void RestingHold::balanced(double h, bool found) {
  h_ = found ? h : 0.0;
  drift_.forget();
  age_ = kWindow;  // the first sub-step of those that follow begins with a look
}

void RestingHold::keep() {
  const auto contacts = resting();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ShaftContact& contact = contacts[i];
    kept_[i] = {contact.force, contact.s, contact.state, contact.fast};
    contact.s_start = contact.s;
    contact.state_start = contact.state;
    contact.fast_start = contact.fast;
  }
  whole_.begin_states();
}

void RestingHold::take_back() {
  const auto contacts = resting();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].force = kept_[i].force;
    contacts[i].s = kept_[i].s;
    contacts[i].state = kept_[i].state;
    contacts[i].fast = kept_[i].fast;
  }
  errors_.clear();
  h_ = 0.0;
}

/// [mm] By how much the arc length of a contact on its needle becomes smaller in the sub-step.
double RestingHold::slides(const ShaftContact& contact, int c) const {
  if (contact.sticks()) return 0.0;
  const Vec3& t = whole_.rows().frame[static_cast<std::size_t>(c)].col(2);
  return contact.sense() * ContactStates::way(contact, t.dot(contact.force));
}

/// Takes over the present yields of the contacts at rest. @return false where B does not fit any longer
bool RestingHold::soften() {
  const std::uint64_t before = grips().version();
  whole_.rows().soften(all_, h_);
  if (!grips().follow()) return false;
  if (grips().version() != before) ++version_;
  return true;
}

/// Lets the sliding contacts yield in z_, and adds it to the forces at rest.
void RestingHold::add_solved() {
  auto z = z_.head(grips().matrix().rows());
  grips().sliding().yield_in(z, grips().matrix());
  auto force = force_.head(grips().matrix().contact_rows());
  grips().matrix().forces(z, force);
  for (int c = 1; c < all_.first_own(); ++c) all_.force(c) += force.segment<3>(3 * c - 3);
}

/// Looks at all laws at rest, and takes what linear equations need from there.
bool RestingHold::look(double h) {
  RestingMatrix& matrix = grips().matrix();
  auto solved = solved_.topRows(matrix.rows());
  if (age_ < kWindow) {
    solved.col(0) = drift_.remember(all_, matrix);
  } else {
    solved.col(0).setZero();
  }
  if (!whole_.settle_rest(h)) return false;
  ++version_;
  age_ = 0;
  drift_.look(all_, matrix);
  creep_.look(all_, solved.col(1).head(matrix.contact_rows()));
  matrix.fill_springs(solved.col(1));
  matrix.solve(solved);
  return true;
}

/// Between looks: the forces at rest follow the creep of this sub-step and the place of the tip, and contacts that
/// slide begin at their present places.
void RestingHold::go_on() {
  RestingMatrix& matrix = grips().matrix();
  ++age_;
  auto z = z_.head(matrix.rows());
  z = creep_.fades(all_.tissue.memory()) * solved_.col(1).head(z.size());
  for (int c = 1; c < all_.first_own(); ++c) {
    if (const double mm = slides(all_.of_shaft(c), c); mm != 0.0) errors_.set(c - 1, mm);
  }
  errors_.answer(matrix, grips().sliding(), z_);
  add_solved();
  z = -drift_.begin(all_, matrix) * solved_.col(0).head(z.size());
  add_solved();
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

/// Takes the present forces as those from which the moved needle's are counted.
void RestingHold::take_start() {
  HeldTissue& held = grips().held();
  const Eigen::Index own = held.others();
  start_.head<3>() = all_.tip.force;
  for (Eigen::Index at = 3; const ShaftContact& contact : std::as_const(all_.shaft).own()) {
    start_.segment<3>(at) = contact.force;
    at += 3;
  }
  auto force = force_.head(grips().matrix().contact_rows());
  for (int c = 1; c < all_.first_own(); ++c) force.segment<3>(3 * c - 3) = all_.force(c);
  auto moved = moved_.col(0).head(own);
  held.displacement(force, moved);
  moved.noalias() += held.reduction().lazyProduct(start_.head(own));
  held.answer(drift_.at_rest(grips().matrix()), grips().matrix(), grips().sliding(), moved_.block(0, 1, own, 2));
}

bool RestingHold::begin(double h) {
  if (h != h_ || all_.tip.cut.is_stale()) return false;
  keep();
  const bool fits = soften();
  const bool looks = age_ + 1 >= kWindow;
  if (!fits || (looks && !look(h))) {
    take_back();
    return false;
  }
  if (!looks) go_on();
  take_contacts();
  take_start();
  return true;
}

/// Changes the states of contacts at rest that contradict their laws under the forces at rest plus force_, and what
/// that changes in the forces at the start of the sub-step. @return whether there are any
bool RestingHold::change_states(Step& step) {
  ContactStates& states = whole_.states();
  for (int c = 1; c < all_.first_own(); ++c) {
    const ShaftContact& contact = all_.of_shaft(c);
    const Vec3& t = whole_.rows().frame[static_cast<std::size_t>(c)].col(2);
    const double axial = t.dot(contact.force + force_.segment<3>(3 * c - 3));
    const ContactStates::Trial trial{.axial = axial,
                                     .slides = contact.sticks() ? 0.0 : ContactStates::way(contact, axial)};
    if (states.contradiction(c, trial) <= kNoContradiction_N) continue;
    errors_.set(c - 1, -slides(contact, c));
    states.change(c, trial, step);
  }
  return errors_.are_any();
}

RestingHold::Followed RestingHold::follow(bool last, Step& step) {
  RestingMatrix& matrix = grips().matrix();
  if (!drift_.fits(all_, matrix) && !last) return Followed::again;
  const Eigen::Index own = grips().held().others();
  auto change = start_.head(own);  // it is made anew before it is needed again
  change.head<3>() = all_.tip.force - change.head<3>();
  for (Eigen::Index at = 3; const ShaftContact& contact : std::as_const(all_.shaft).own()) {
    change.segment<3>(at) = contact.force - change.segment<3>(at);
    at += 3;
  }
  auto z = z_.head(matrix.rows());
  z.setZero();
  grips().held().subtract(change, z);
  grips().sliding().yield_in(z, matrix);
  auto force = force_.head(matrix.contact_rows());
  matrix.forces(z, force);

  if (change_states(step)) {
    if (!soften()) return Followed::no;
    for (const int grip : errors_.contacts()) errors_.add(grip, slides(all_.of_shaft(grip + 1), grip + 1));
    z.setZero();
    errors_.answer(matrix, grips().sliding(), z_);
    add_solved();
    return Followed::again;
  }
  for (int c = 1; c < all_.first_own(); ++c) {
    ShaftContact& contact = all_.of_shaft(c);
    contact.force += force.segment<3>(3 * c - 3);
    contact.s = contact.s_start - slides(contact, c);
    contact.slid = contact.s - contact.s_start;
    contact.slid_more = 0.0;
    contact.history = {};
  }
  return Followed::done;
}

Mat3 RestingHold::reduction(int point, int other) const {
  return grips().held().reduction().block<3, 3>(own_.row(point), own_.row(other));
}

Vec3 RestingHold::displacement(int point) const {
  const Eigen::Index at = own_.row(point);
  const double cut = all_.tip.touches() ? all_.tip.cut.advance() : 0.0;
  const Vec3 drifted = moved_.block<3, 1>(at, 1) + cut * moved_.block<3, 1>(at, 2);
  if (point != ContactCompliance::kTip) return moved_.block<3, 1>(at, 0) - drifted;
  // The tip is at another place than at the start of the sub-step.
  const HeldTissue& held = grips().held();
  Vec3 moved = held.reduction().topRows<3>().lazyProduct(start_.head(held.others()));
  for (int c = 1; c < all_.first_own(); ++c)
    moved.noalias() +=
        all_.tissue.own_compliance_now(all_.point(c), ContactCompliance::kTip).transpose() * all_.force(c);
  return moved - drifted;
}

Vec3 RestingHold::of_others() const {
  const MatX& scale = all_.tissue.compliance().needle_scale();
  Vec3 sum = Vec3::Zero();
  for (const ShaftContact& contact : resting())
    sum.noalias() += scale.middleRows<3>(3 * contact.point).transpose() * contact.force;
  return sum;
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): the result is written through its view
void RestingHold::write_forces(Eigen::Ref<MatX> forces) const {
  for (const ShaftContact& contact : resting()) forces.col(contact.point) = contact.force;
}

}  // namespace stylet

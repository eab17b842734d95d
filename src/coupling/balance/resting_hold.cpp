// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_hold.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// Sub-steps from one look at all laws to the next. Raised, what linear equations leave over grows, with its square;
/// lowered, more sub-steps read the whole compliance among the contacts at rest.
constexpr int kWindow = 10;
/// How often the moved needle is balanced in a sub-step before all needles are balanced together. Raised, sub-steps in
/// which contacts at rest change their states take longer.
constexpr int kMostBalances = 4;
/// [N] Contradictions below this are rounding.
constexpr double kNoContradiction_N = 1e-12;
/// [mm] From a shorter cut no derivative is computed.
constexpr double kShortestCut_mm = 1e-5;
/// [mm] Tolerance of E. Raised, fewer sub-steps balance the moved needle twice.
constexpr double kSameDrift_mm = 5e-5;
}  // namespace

RestingHold::RestingHold(const Contacts& all, CoupledBalance& whole, int most_own, int points)
    : all_(all), whole_(whole), grips_(whole.system().resting()) {
  const Eigen::Index rows = RestingMatrix::most_rows(grips_.count());
  const Eigen::Index own = 3 * static_cast<Eigen::Index>(most_own);
  kept_.resize(static_cast<std::size_t>(grips_.count()));
  points_.reserve(static_cast<std::size_t>(most_own));
  index_.assign(static_cast<std::size_t>(points), 0);
  start_ = moved_ = VecX::Zero(own);
  last_.tip_moves = last_.usual = work_.z = work_.force = VecX::Zero(rows);
  last_.tip_columns = work_.columns = MatX::Zero(rows, 3);
  work_.errors = MatX::Zero(rows, 1);
  work_.fading = VecX::Zero(3 * static_cast<Eigen::Index>(points));
  work_.change = start_;
  work_.changing.reserve(kept_.size());
  drift_.at_rest = last_.solved = MatX::Zero(rows, 2);
  drift_.of_moved = MatX::Zero(own, 2);
  work_.of_sliding = MatX::Zero(grips_.count(), 2);
}

void RestingHold::balanced(double h, bool found) {
  h_ = found ? h : 0.0;
  drift_.at_rest.setZero();
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
  h_ = 0.0;
}

/// [mm/N] Compliance of the tissue between a point and a contact at rest in this sub-step.
Mat3 RestingHold::compliance(int point, int contact) const {
  const ContactCompliance& tissue = all_.tissue.compliance();
  const int other = all_.point(contact);
  Mat3 now = tissue(other, point);
  if (const double share = all_.tissue.creep_share(); share > 0.0) now += share * tissue.wide(other, point);
  return now;
}

/// [mm] How far the force on the tip moves a contact at rest.
Vec3 RestingHold::more_of_tip(int contact, const TipRelief& relief) const {
  return compliance(ContactCompliance::kTip, contact) * all_.tip.force - relief.of(all_.point(contact));
}

/// [mm] How far a contact slides in the sub-step, towards the needle's base.
double RestingHold::away(const ShaftContact& contact, int c) const {
  if (contact.sticks()) return 0.0;
  const Vec3& t = whole_.rows().frame[static_cast<std::size_t>(c)].col(2);
  return contact.sense() * ContactStates::way(contact, t.dot(contact.force));
}

/// Takes over the present yields of the contacts at rest. @return false where B does not fit any longer
bool RestingHold::soften() {
  const std::uint64_t before = grips_.version();
  whole_.rows().soften(all_, h_);
  if (!grips_.follow()) return false;
  if (grips_.version() != before) ++version_;
  return true;
}

/// Adds to z what an error along a contact that slides changes.
void RestingHold::err(VecX& z, int c, double mm) {
  if (mm == 0.0) return;
  const RestingMatrix& matrix = grips_.matrix();
  if (grips_.sliding().is_known(c - 1)) {
    z.head(matrix.rows()) -= mm * grips_.sliding().column(c - 1, matrix);
    return;
  }
  if (!work_.errs) work_.errors.setZero();
  work_.errs = true;
  work_.errors.block<3, 1>(3 * c - 3, 0) -= mm * matrix.yield(c - 1).along;
}

/// Adds what errors along contacts without a solved column change.
void RestingHold::add_errors(VecX& z) {
  if (!work_.errs) return;
  work_.errs = false;
  RestingMatrix& matrix = grips_.matrix();
  auto errors = work_.errors.topRows(matrix.rows());
  matrix.fill_springs(errors.col(0));
  matrix.solve(errors);
  z.head(matrix.rows()) += errors.col(0);
}

/// Adds a solved column, in which the sliding contacts yield, to the forces.
void RestingHold::add(const Eigen::Ref<const VecX>& z) {
  const Eigen::Index n = grips_.matrix().contact_rows();
  auto force = work_.force.head(n);
  grips_.matrix().forces(z, force);
  const auto contacts = resting();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    contacts[i].force += force.segment<3>(3 * static_cast<Eigen::Index>(i));
}

/// Looks at all laws at rest, and takes what linear equations need from there.
bool RestingHold::look(double h) {
  const RestingMatrix& matrix = grips_.matrix();
  auto usual = last_.usual.head(matrix.rows());
  if (age_ < kWindow) {
    drift_to(usual);
  } else {
    usual.setZero();
  }
  if (!whole_.settle_rest(h)) return false;
  ++version_;
  age_ = 0;
  last_.faded = 1.0;
  last_.drifted_as_usual = 0.0;
  const TipRelief relief = all_.tissue.relief(all_.forces());
  last_.tip_force = all_.tip.force;
  for (int c = 1; c < all_.first_own(); ++c) {
    last_.tip_moves.segment<3>(3 * c - 3) = more_of_tip(c, relief);
    Mat3 column = compliance(ContactCompliance::kTip, c);
    if (relief.is_any()) column -= relief.slope(all_.point(c));
    last_.tip_columns.middleRows<3>(3 * c - 3) = column;
  }
  auto solved = last_.solved.topRows(matrix.rows());
  solved.col(0) = usual;
  solved.col(1).setZero();
  if (all_.tissue.memory().on()) fade(solved.col(1));
  grips_.matrix().solve(solved);
  return true;
}

/// Writes what the lasting forces move at rest, minus what they will move in the end. Under constant forces λ the
/// memory m goes to λ, so (r − 1) F (m − λ) fades.
void RestingHold::fade(Eigen::Ref<VecX> z) {
  const TissueMemory& memory = all_.tissue.memory();
  const ContactCompliance& tissue = all_.tissue.compliance();
  const Eigen::Index count = 3 * Eigen::Index{tissue.points()};
  auto fading = work_.fading.head(count);
  for (int p = 0; p < tissue.points(); ++p) fading.segment<3>(3 * p) = memory.most() * memory.remembered(p);
  fading.head<3>() -= memory.most() * all_.tip.force;
  for (const ShaftContact& contact : all_.shaft.all())
    fading.segment<3>(3 * contact.point) -= memory.most() * contact.force;
  for (int c = 1; c < all_.first_own(); ++c) {
    const auto columns = tissue.wide().block(0, 3 * all_.point(c), count, 3);  // or rows: F is symmetric
    z.segment<3>(3 * c - 3) = columns.transpose().lazyProduct(fading);
  }
  grips_.matrix().fill_springs(z);
}

/// The lasting forces of this sub-step displace the contacts at rest, and those that slide begin at their present
/// places.
void RestingHold::creep_on() {
  auto z = work_.z.head(grips_.matrix().rows());
  z.setZero();
  if (all_.tissue.memory().on()) {
    const double kept = all_.tissue.memory().kept();
    z = (kept * last_.faded - kept * last_.faded * kept) * last_.solved.col(1).head(z.size());
    last_.faded *= kept;
  }
  for (int c = 1; c < all_.first_own(); ++c) err(work_.z, c, away(all_.of_shaft(c), c));
  add_errors(work_.z);
  grips_.sliding().yield_in(z, grips_.matrix());
  add(z);
}

/// Takes over the moved needle's contacts.
void RestingHold::take_contacts() {
  const auto own = std::as_const(all_.shaft).own();
  std::size_t same = 0;
  while (same < std::min(own.size(), points_.size()) && own[same].point == points_[same]) ++same;
  same = std::min(same, static_cast<std::size_t>(grips_.held().known()) - 1);
  grips_.keep_first(static_cast<int>(same) + 1);
  points_.resize(same);
  auto A = work_.columns.topRows(grips_.matrix().contact_rows());
  for (std::size_t k = same; k < own.size(); ++k) {
    for (int c = 1; c < all_.first_own(); ++c) A.middleRows<3>(3 * c - 3) = compliance(own[k].point, c);
    grips_.add(A);
    points_.push_back(own[k].point);
    ++version_;
  }
  index_[ContactCompliance::kTip] = 0;
  for (std::size_t k = 0; k < points_.size(); ++k)
    index_[static_cast<std::size_t>(points_[k])] = static_cast<Eigen::Index>(k) + 1;
}

/// Takes the present forces as those from which the moved needle's are counted.
void RestingHold::take_start() {
  const Eigen::Index n = grips_.matrix().contact_rows();
  const Eigen::Index own = grips_.held().others();
  start_.head<3>() = all_.tip.force;
  for (std::size_t k = 0; k < points_.size(); ++k)
    start_.segment<3>(3 * static_cast<Eigen::Index>(k) + 3) = std::as_const(all_.shaft).own()[k].force;
  auto force = work_.force.head(n);
  for (int c = 1; c < all_.first_own(); ++c) force.segment<3>(3 * c - 3) = all_.of_shaft(c).force;
  auto moved = moved_.head(own);
  grips_.held().displacement(force, moved);
  moved.noalias() += grips_.held().reduction().lazyProduct(start_.head(own));
  grips_.held().answer(drift_.at_rest.topRows(grips_.matrix().rows()), grips_.matrix(), grips_.sliding(),
                       drift_.of_moved.topRows(own), work_.of_sliding);
}

/// Writes E at the present place of the tip.
void RestingHold::drift_to(Eigen::Ref<VecX> E) const {
  const TipRelief relief = all_.tissue.relief(all_.forces());
  const Vec3 more = all_.tip.force - last_.tip_force;
  for (int c = 1; c < all_.first_own(); ++c)
    E.segment<3>(3 * c - 3) = more_of_tip(c, relief) - last_.tip_moves.segment<3>(3 * c - 3) -
                              last_.tip_columns.middleRows<3>(3 * c - 3) * more;
  grips_.matrix().fill_springs(E);
}

/// Begins with E at the present place of the tip. As far as it is like E at the end of the window before, its answer is
/// known, and the forces at rest follow at once.
void RestingHold::begin_drift() {
  const Eigen::Index rows = grips_.matrix().rows();
  auto E = drift_.at_rest.col(0).head(rows);
  if (age_ == 0) {
    E.setZero();
    return;
  }
  drift_to(E);
  const auto usual = last_.usual.head(rows);
  const double square = usual.squaredNorm();
  if (square == 0.0) return;
  const double like = E.dot(usual) / square;
  auto z = work_.z.head(rows);
  z = (last_.drifted_as_usual - like) * last_.solved.col(0).head(rows);
  last_.drifted_as_usual = like;
  grips_.sliding().yield_in(z, grips_.matrix());
  add(z);
  E -= like * usual;
}

/// After a balance: whether E is now what it was taken for; if not, its change along the cut is corrected.
bool RestingHold::drift_fits() {
  const Eigen::Index rows = grips_.matrix().rows();
  const double cut = all_.tip.touches() ? all_.tip.cut.advance() : 0.0;
  if (cut < kShortestCut_mm) return true;
  auto E = work_.z.head(rows);
  drift_to(E);
  E -= last_.drifted_as_usual * last_.usual.head(rows) + drift_.at_rest.col(0).head(rows);
  const double off = (E - cut * drift_.at_rest.col(1).head(rows)).lpNorm<Eigen::Infinity>();
  drift_.at_rest.col(1).head(rows) = E / cut;
  return off < kSameDrift_mm;
}

bool RestingHold::begin(double h) {
  if (h != h_ || all_.tip.cut.is_stale()) return false;
  keep();
  rounds_ = 0;
  if (!soften()) {
    take_back();
    return false;
  }
  if (age_ + 1 >= kWindow) {
    if (!look(h)) {
      take_back();
      return false;
    }
  } else {
    ++age_;
    creep_on();
  }
  take_contacts();
  begin_drift();
  take_start();
  return true;
}

RestingHold::Followed RestingHold::follow(Step& step) {
  if (!drift_fits() && ++rounds_ < kMostBalances) return Followed::again;
  const RestingMatrix& matrix = grips_.matrix();
  const Eigen::Index own = grips_.held().others();
  const Eigen::Index n = matrix.contact_rows();
  VecX& change = work_.change;
  change.head<3>() = all_.tip.force - start_.head<3>();
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Eigen::Index at = 3 * static_cast<Eigen::Index>(k) + 3;
    change.segment<3>(at) = std::as_const(all_.shaft).own()[k].force - start_.segment<3>(at);
  }
  auto z = work_.z.head(matrix.rows());
  z.setZero();
  grips_.held().subtract(change.head(own), z);
  grips_.sliding().yield_in(z, matrix);
  auto force = work_.force.head(n);
  matrix.forces(z, force);

  ContactStates& states = whole_.states();
  const ContactRows& rows = whole_.rows();
  auto error = work_.columns.col(0);
  for (int c = 1; c < all_.first_own(); ++c) {
    ShaftContact& contact = all_.of_shaft(c);
    const Vec3 t = rows.frame[static_cast<std::size_t>(c)].col(2);
    const double axial = t.dot(contact.force + force.segment<3>(3 * c - 3));
    const ContactStates::Trial trial{.axial = axial,
                                     .slides = contact.sticks() ? 0.0 : ContactStates::way(contact, axial)};
    if (states.contradiction(c, trial) <= kNoContradiction_N) continue;
    error[c] = -away(contact, c);
    work_.changing.push_back(c);
    states.change(c, trial, step);
  }
  if (work_.changing.empty()) {
    for (int c = 1; c < all_.first_own(); ++c) {
      ShaftContact& contact = all_.of_shaft(c);
      contact.force += force.segment<3>(3 * c - 3);
      contact.s = contact.s_start - away(contact, c);
      contact.slid = contact.s - contact.s_start;
      contact.slid_more = 0.0;
      contact.history = {};
    }
    return Followed::done;
  }
  const bool fits = ++rounds_ < kMostBalances && soften();
  z.setZero();
  for (const int c : work_.changing) {
    if (fits) err(work_.z, c, away(all_.of_shaft(c), c) + error[c]);
  }
  work_.changing.clear();
  if (!fits) return Followed::no;
  add_errors(work_.z);
  grips_.sliding().yield_in(z, matrix);
  add(z);
  return Followed::again;
}

Mat3 RestingHold::reduction(int point, int other) const {
  return grips_.held().reduction().block<3, 3>(own_index(point), own_index(other));
}

Vec3 RestingHold::displacement(int point) const {
  const Eigen::Index at = own_index(point);
  const double cut = all_.tip.touches() ? all_.tip.cut.advance() : 0.0;
  const Vec3 drifted = drift_.of_moved.block<3, 1>(at, 0) + cut * drift_.of_moved.block<3, 1>(at, 1);
  if (point != ContactCompliance::kTip) return moved_.segment<3>(at) - drifted;
  // The tip is at another place than at the last look.
  Vec3 moved = grips_.held().reduction().topRows<3>().lazyProduct(start_.head(grips_.held().others()));
  for (int c = 1; c < all_.first_own(); ++c)
    moved.noalias() += compliance(ContactCompliance::kTip, c).transpose() * all_.of_shaft(c).force;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/needle_tangent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {
/// After this many tangents on springs, one without springs is tried. Raised, a needle that has become stable keeps its
/// springs longer.
constexpr int kTryWithout = 16;
/// Number of springs that is usually enough. Raised, each matrix costs more, and fewer matrices have to be made twice.
constexpr int kFewSprings = 6;
/// [mm/N] Least compliance of the tissue in a spring's stiffness. Lowered, springs on bone make the matrix
/// ill-conditioned.
constexpr double kHardest_mm_per_N = 1e-3;
/// [mm] Motion of the base after which the next tangent is begun. Raised, tangents are older and iterations more, and
/// more tangents have to be made at once.
constexpr double kWornOut_mm = 1.0;
/// [mm] The same for a damped needle, which is on bone or snaps.
constexpr double kWornOutDamped_mm = 2.0;
/// Change of the damping ratio, over 1 + the ratio, that needs another tangent. Raised, a damped needle takes more
/// iterations.
constexpr double kOtherDamping = 0.25;
}  // namespace

NeedleTangent::NeedleTangent(Needle& needle, ContactSystem& system, const ContactRows& rows, int most_contacts)
    : needle_(needle), system_(system), rows_(rows), springs_(static_cast<std::size_t>(most_contacts), Mat3::Zero()) {
  points_.reserve(static_cast<std::size_t>(most_contacts));
}

void NeedleTangent::forget() {
  fits_ = false;
  stage_ = Stage::none;
}

void NeedleTangent::release() {
  system_.needle.own_supported = false;
  if (resting_lent_ > 0) {
    fits_ = false;  // springs of needles at rest stay
  } else {
    system_.needle.supported = false;
  }
  on_springs_for_ = 0;
  stage_ = Stage::none;
}

/// Whether a tangent is made on springs from the start, like the last one; from time to time it is tried without.
bool NeedleTangent::expects_springs() { return system_.needle.own_supported && ++on_springs_for_ < kTryWithout; }

void NeedleTangent::linearise(const Contacts& contacts, bool resting_too, bool advances, Effort& effort) {
  const int count = contacts.count();
  NeedleSide& side = system_.needle;
  side.count = count;
  const bool with_resting = contacts.bundle != nullptr && (resting_too || !resting_made_);
  if (contacts.bundle != nullptr) contacts.bundle->keep_resting(!with_resting);
  int own = advances && expects_springs() ? kFewSprings : 0;
  if (own == 0) on_springs_for_ = 0;
  // A needle at rest that has needed springs will need them again: its load hardly changes.
  bool all = false;
  while (true) {
    const bool few = own > 0 && (resting_lent_ > 0 || !with_resting);
    const bool last = all || (few && count <= kFewSprings + 1);
    effort.spend(effort.needle() + (all ? effort.matrix_on_all_springs() - effort.matrix() : 0.0));
    lend_springs(contacts, own, side);
    if (with_resting) lend_springs_at_rest(contacts, side);
    side.supported = own > 0 || resting_lent_ > 0;
    std::span<const Mat3> lent;
    if (side.supported) lent = {springs_.data(), static_cast<std::size_t>(count)};
    const Indefinite otherwise = last ? Indefinite::shift : Indefinite::give_up;
    if (needle_.linearise(rows_.loads(), side.compliance(), side.motion(), lent, otherwise) || last) break;
    // A few springs for each needle are usually enough, and cheaper; springs at all contacts always are.
    if (own == 0) {
      own = kFewSprings;
    } else if (!few) {
      resting_lent_ = kFewSprings;
    } else {
      all = true;
      own = count;
      if (with_resting) resting_lent_ = count;
    }
  }
  resting_lent_ = std::min(resting_lent_, kFewSprings);
  fits_ = true;
  if (with_resting) {
    resting_made_ = true;
    system_.outdate_all();
  }
  system_.outdate();
  stage_ = Stage::none;
  worn_mm_ = 0.0;
}

bool NeedleTangent::relax() { return fits_ && needle_.relax(rows_.loads(), system_.needle.motion()); }

bool NeedleTangent::relax_resting(const Contacts& contacts) {
  std::span<const Mat3> lent;
  if (resting_lent_ > 0) lent = springs_;
  return contacts.bundle->relax_resting(rows_.loads(), system_.needle.free, lent);
}

void NeedleTangent::append(int load) {
  const auto loads = rows_.loads().first(static_cast<std::size_t>(load) + 1);
  fits_ = fits_ && needle_.append(loads, system_.needle.next_rows());
  if (!fits_) return;
  system_.needle.add_contact();
  system_.append();
}

void NeedleTangent::damp(double ratio) {
  if (ratio == 0.0 && damping_ == 0.0) return;
  damping_ = ratio;
  needle_.damp(ratio);
  // With a tangent for another damping, iterations converge more slowly, the more the dampings differ.
  if (std::abs(ratio - tangent_damping_) <= kOtherDamping * (1.0 + tangent_damping_)) return;
  tangent_damping_ = ratio;
  forget();
}

void NeedleTangent::wear_out() { worn_mm_ = std::numeric_limits<double>::infinity(); }

/// Lends a spring at a load: a lateral one, as stiff as the tissue is there alone, times the number of contacts that it
/// stands for. @param stands_for 0: no spring
void NeedleTangent::lend_spring(const Contacts& contacts, int load, int stands_for, NeedleSide& side) {
  double own = system_.A.block<3, 3>(3 * load, 3 * load).trace() / 3.0;
  if (load > 0) own += contacts.of_shaft(load).softness;
  const auto l = static_cast<std::size_t>(load);
  LentSpring& spring = side.spring[l];
  spring.along = load == 0 ? Vec3::Zero() : Vec3(rows_.frame[l].col(2));
  spring.stiffness = stands_for > 0 ? stands_for / std::max(own, kHardest_mm_per_N) : 0.0;
  springs_[l] = spring.matrix();
}

/// Lends springs to the contacts first … end − 1 of one needle, evenly spread and including the last one.
/// @param most largest number of springs; 0: none @return for how many contacts each spring stands; 0: no spring
int NeedleTangent::lend_springs_to(const Contacts& contacts, int first, int end, int most, NeedleSide& side) {
  const int every = most > 0 ? (std::max(end - first, 1) + most - 1) / most : 0;
  for (int c = first; c < end; ++c) lend_spring(contacts, c, every > 0 && (end - 1 - c) % every == 0 ? every : 0, side);
  return every;
}

/// Lends springs to the moved needle. All springs of a needle together are stiffer than the tissue, so the needle on
/// them does not buckle where needle and tissue together do not. A few springs stand for all. A tip that is held has a
/// spring of this stiffness, too, because shaft contacts alone do not stabilise a needle that has bowed out between
/// hand and bone.
/// @param most largest number of springs; 0: none @param side its springs are written
void NeedleTangent::lend_springs(const Contacts& contacts, int most, NeedleSide& side) {
  side.own_supported = most > 0;
  if (most == 0 && contacts.bundle == nullptr) return;
  const int every = lend_springs_to(contacts, contacts.first_own(), contacts.count(), most, side);
  lend_spring(contacts, 0, contacts.tip.holds() ? every : 0, side);
}

/// Lends springs to each needle at rest.
void NeedleTangent::lend_springs_at_rest(const Contacts& contacts, NeedleSide& side) {
  for (int first = 1; first < contacts.first_own();) {
    int end = first + 1;
    while (end < contacts.first_own() && &contacts.needle_of(end) == &contacts.needle_of(first)) ++end;
    lend_springs_to(contacts, first, end, resting_lent_, side);
    first = end;
  }
}

void NeedleTangent::prepare(const Contacts& contacts) {
  if (!needle_.prepares() || !fits_ || !system_.fits()) return;
  if (stage_ == Stage::none) {
    if (worn_mm_ < (is_damped() ? kWornOutDamped_mm : kWornOut_mm)) return;
    lent_ = expects_springs() ? kFewSprings : 0;
    if (lent_ == 0) on_springs_for_ = 0;
    stage_ = Stage::begun;
  }
  if (stage_ != Stage::begun && !prepared_contacts_are_there(contacts)) {
    stage_ = Stage::none;
    return;
  }
  switch (stage_) {
    case Stage::begun:
      if (prepare_on_springs(contacts)) stage_ = Stage::tangent;
      break;
    case Stage::tangent:
      if (needle_.prepared_compliance(system_.prepared.compliance())) stage_ = Stage::compliance;
      break;
    case Stage::compliance:
      system_.fill_prepared();
      stage_ = Stage::filled;
      break;
    case Stage::filled:
      stage_ = system_.factorise_prepared() ? Stage::matrix : Stage::none;
      break;
    default:
      break;
  }
}

/// Begins the next tangent at the present shape, on the expected number of springs. Returns false where it needs more
/// springs; the next attempt uses them. Needles at rest keep their tangents, and with them their springs.
bool NeedleTangent::prepare_on_springs(const Contacts& contacts) {
  const int count = contacts.count();
  NeedleSide& side = system_.prepared;
  const NeedleSide& now = system_.needle;
  lend_springs(contacts, lent_, side);
  std::copy(now.spring.begin() + 1, now.spring.begin() + contacts.first_own(), side.spring.begin() + 1);
  side.supported = lent_ > 0 || resting_lent_ > 0;
  std::span<const Mat3> lent;
  if (side.own_supported) lent = {springs_.data(), static_cast<std::size_t>(count)};
  const bool more = lent_ < std::max(count - 1, 1);
  if (!needle_.prepare(rows_.loads(), lent, more ? Indefinite::give_up : Indefinite::shift) && more) {
    lent_ = lent_ == 0 ? kFewSprings : count;
    return false;
  }
  side.count = count;
  points_.clear();
  for (int c = 0; c < count; ++c) points_.push_back(contacts.point(c));
  return true;
}

/// Whether the contacts that the next tangent belongs to are still the first of the present contacts.
bool NeedleTangent::prepared_contacts_are_there(const Contacts& contacts) const {
  const auto count = static_cast<int>(points_.size());
  if (count > contacts.count()) return false;
  for (int c = 0; c < count; ++c) {
    if (points_[static_cast<std::size_t>(c)] != contacts.point(c)) return false;
  }
  return true;
}

std::span<const int> NeedleTangent::take_prepared(const Contacts& contacts) {
  if (stage_ != Stage::matrix) return {};
  stage_ = Stage::none;
  if (!prepared_contacts_are_there(contacts)) return {};
  needle_.take_prepared();
  system_.take_prepared();
  fits_ = true;
  worn_mm_ = 0.0;
  return points_;
}

}  // namespace stylet

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
/// [mm] Motion of the base after which the next tangent is begun. Raised, tangents are older and iterations more.
constexpr double kWornOut_mm = 2.0;
/// Change of the damping ratio, over 1 + the ratio, that needs another tangent. Raised, a damped needle takes more
/// iterations.
constexpr double kOtherDamping = 0.25;
}  // namespace

NeedleTangent::NeedleTangent(Needle& needle, ContactSystem& system, const ContactRows& rows, int most_contacts,
                             PhaseObserver* const& phases)
    : needle_(needle),
      system_(system),
      rows_(rows),
      phases_(phases),
      springs_(static_cast<std::size_t>(most_contacts), Mat3::Zero()) {
  points_.reserve(static_cast<std::size_t>(most_contacts));
}

void NeedleTangent::forget() {
  fits_ = false;
  stage_ = Stage::none;
}

void NeedleTangent::release() {
  system_.needle.supported = false;
  on_springs_for_ = 0;
  stage_ = Stage::none;
}

/// Whether a tangent is made on springs from the start, like the last one; from time to time it is tried without.
bool NeedleTangent::expects_springs() { return system_.needle.supported && ++on_springs_for_ < kTryWithout; }

void NeedleTangent::linearise(const Contacts& contacts, bool advances, Effort& effort) {
  const InPhase in_phase(phases_, StepPhase::needle_tangent);
  const int count = contacts.count();
  NeedleSide& side = system_.needle;
  side.count = count;
  const bool expected = advances && expects_springs();
  if (!expected) effort.spend(effort.needle());
  const auto linearise_on = [&](std::span<const Mat3> springs, Indefinite otherwise) {
    return needle_.linearise(rows_.loads(), side.compliance(), side.motion(), springs, otherwise);
  };
  side.supported = expected || !linearise_on({}, Indefinite::give_up);
  if (!expected) on_springs_for_ = 0;
  if (side.supported) {
    // Springs at a few contacts are usually enough, and cheaper; springs at all contacts always are.
    const std::span<const Mat3> lent(springs_.data(), static_cast<std::size_t>(count));
    lend_springs(contacts, kFewSprings, side.spring);
    effort.spend(effort.needle());
    const bool more = count > kFewSprings + 1;
    if (!linearise_on(lent, more ? Indefinite::give_up : Indefinite::shift) && more) {
      lend_springs(contacts, count, side.spring);
      effort.spend(effort.needle() + effort.matrix_on_all_springs() - effort.matrix());
      linearise_on(lent, Indefinite::shift);
    }
  }
  fits_ = true;
  system_.outdate();
  stage_ = Stage::none;
  worn_mm_ = 0.0;
}

bool NeedleTangent::relax() {
  const InPhase in_phase(phases_, StepPhase::needle_relax);
  return fits_ && needle_.relax(rows_.loads(), system_.needle.motion());
}

void NeedleTangent::append(int load) {
  const InPhase in_phase(phases_, StepPhase::factorise);
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

/// Writes the springs: lateral springs, each as stiff as the tissue is at that contact alone. Together they are stiffer
/// than the tissue, so the needle on them does not buckle where needle and tissue together do not. A few springs stand
/// for all: each is as stiff as the springs of all contacts that it stands for. A tip that is held has a spring of this
/// stiffness, too, because shaft contacts alone do not stabilise a needle that has bowed out between hand and bone.
/// Needles at rest hardly ever need springs: they get theirs only where all contacts do.
/// @param most largest number of springs, evenly spaced and including the last contact @param lent (contacts) written
void NeedleTangent::lend_springs(const Contacts& contacts, int most, std::vector<LentSpring>& lent) {
  const int count = contacts.count();
  const int first = most < count ? contacts.first_own() : 1;
  const int every = (std::max(count - first, 1) + most - 1) / most;
  for (int c = 0; c < count; ++c) {
    double own = system_.A.block<3, 3>(3 * c, 3 * c).trace() / 3.0;
    bool lend = true;
    if (c == 0) {
      lend = contacts.tip.holds();
    } else {
      own += contacts.of_shaft(c).softness;
      lend = c >= first && (count - 1 - c) % every == 0;
    }
    LentSpring& spring = lent[static_cast<std::size_t>(c)];
    spring.along = c == 0 ? Vec3::Zero() : Vec3(rows_.frame[static_cast<std::size_t>(c)].col(2));
    spring.stiffness = lend ? every / std::max(own, kHardest_mm_per_N) : 0.0;
    springs_[static_cast<std::size_t>(c)] = spring.matrix();
  }
}

void NeedleTangent::prepare(const Contacts& contacts) {
  if (!needle_.prepares() || !fits_ || !system_.fits()) return;
  if (stage_ == Stage::none) {
    if (worn_mm_ < kWornOut_mm) return;
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
    case Stage::tangent: {
      const InPhase in_phase(phases_, StepPhase::needle_tangent);
      if (needle_.prepared_compliance(system_.prepared.compliance())) stage_ = Stage::compliance;
      break;
    }
    case Stage::compliance: {
      const InPhase in_phase(phases_, StepPhase::factorise);
      system_.fill_prepared();
      stage_ = Stage::filled;
      break;
    }
    case Stage::filled: {
      const InPhase in_phase(phases_, StepPhase::factorise);
      stage_ = system_.factorise_prepared() ? Stage::matrix : Stage::none;
      break;
    }
    default:
      break;
  }
}

/// Begins the next tangent at the present shape, on the expected number of springs. Returns false where it needs more
/// springs; the next attempt uses them.
bool NeedleTangent::prepare_on_springs(const Contacts& contacts) {
  const InPhase in_phase(phases_, StepPhase::needle_tangent);
  const int count = contacts.count();
  std::span<const Mat3> lent;
  if (lent_ > 0) {
    lend_springs(contacts, lent_, system_.prepared.spring);
    lent = {springs_.data(), static_cast<std::size_t>(count)};
  }
  const bool more = lent_ < std::max(count - 1, 1);
  if (!needle_.prepare(rows_.loads(), lent, more ? Indefinite::give_up : Indefinite::shift) && more) {
    lent_ = lent_ == 0 ? kFewSprings : count;
    return false;
  }
  system_.prepared.count = count;
  system_.prepared.supported = lent_ > 0;
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

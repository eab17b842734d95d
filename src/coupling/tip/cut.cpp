// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/tip/cut.hpp"

#include <algorithm>

namespace stylet {

namespace {
/// [mm] Longest cut in a sub-step, and the range of the search for the next surface. Raised, the search takes longer.
constexpr double kReach_mm = 4.0;
/// [mm] Longest leg of a cut. Raised, a cut behind a surface that breaks keeps a direction that the tissue there has
/// lost; lowered, its sub-step takes longer. A cut that follows the hand is shorter.
constexpr double kLeg_mm = 0.4;
constexpr auto kMostLegs = static_cast<std::size_t>(kReach_mm / kLeg_mm) + 1;
}  // namespace

Cut::Cut(const Locator& locator, TissueResponse& tissue) : locator_(locator), tissue_(tissue) {
  legs_.reserve(kMostLegs);
}

void Cut::put(const Vec3& x, const MaterialPoint& at) {
  forget();
  end_.x = x;
  end_.at = at;
  count_from_here();
  take_compliance();
}

void Cut::forget() {
  end_ = {};
  direction_ = Vec3::UnitZ();
  passed_ = {};
  blocked_ = ends_leg_ = false;
  stale_ = false;
  count_from_here();
}

void Cut::count_from_here() {
  end_.advance = 0.0;
  start_ = end_;
  legs_.clear();
}

void Cut::begin() {
  blocked_ = ends_leg_ = false;
  count_from_here();
}

void Cut::march(double advance) {
  const double way = std::max(0.0, std::min(advance, kReach_mm) - start_.advance);
  const Vec3 target = start_.x + way * direction_;
  MaterialPoint end;
  blocked_ = ends_leg_ = false;
  if (const auto crossing = locator_.first_crossing(start_.x, start_.at.tet, target, end)) {
    blocked_ = true;
    crossing_ = *crossing;
    end_.x = start_.x + crossing->t * (target - start_.x);
    end.tet = crossing->tet;
    end.weights = locator_.weights(end.tet, end_.x);
  } else {
    end_.x = target;
  }
  end_.at = end;
  end_.advance = start_.advance + (end_.x - start_.x).norm();
  take_compliance();
}

void Cut::march_in_leg(double advance) {
  const double longest = start_.advance + kLeg_mm;
  march(std::min(advance, longest));
  ends_leg_ = advance > longest && longest < kReach_mm && !blocked_;
}

void Cut::march_before_surface(double advance) {
  march(advance);
  if (blocked_) march(0.0);
  blocked_ = false;
}

void Cut::begin_leg() {
  legs_.push_back(start_);
  start_ = end_;
  ends_leg_ = false;
}

void Cut::take_back() {
  if (!legs_.empty()) start_ = legs_.front();
  legs_.clear();
  march(0.0);
}

void Cut::enter(Index tet, const Vec3& inwards, const Vec3& tangent) {
  passed_ = PassedSurface(end_.x, inwards, direction_, tangent);
  if (tet != end_.at.tet) {
    end_.at.tet = tet;
    end_.at.weights = locator_.weights(tet, end_.x);
    take_compliance();
  }
  count_from_here();
}

}  // namespace stylet

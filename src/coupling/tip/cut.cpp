// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/tip/cut.hpp"

#include <algorithm>

namespace stylet {

namespace {
/// [mm] Longest cut in a sub-step, and the range of the search for the next surface. Raised, the search takes longer.
constexpr double kReach_mm = 4.0;
}  // namespace

void Cut::put(const Vec3& x, const MaterialPoint& at) {
  forget();
  x_ = x;
  at_ = at;
  count_from_here();
  stale_ = !tissue_.move_tip(at_, x_);
}

void Cut::forget() {
  x_.setZero();
  at_ = {};
  direction_ = Vec3::UnitZ();
  blocked_ = false;
  stale_ = false;
  count_from_here();
}

void Cut::count_from_here() {
  x_start_ = x_;
  at_start_ = at_;
  advance_ = 0.0;
}

void Cut::begin() {
  blocked_ = false;
  count_from_here();
}

void Cut::march(double advance) {
  advance = std::min(advance, kReach_mm);
  const Vec3 target = x_start_ + advance * direction_;
  MaterialPoint end;
  blocked_ = false;
  if (const auto crossing = locator_.first_crossing(x_start_, at_start_.tet, target, end)) {
    blocked_ = true;
    crossing_ = *crossing;
    x_ = x_start_ + crossing->t * (target - x_start_);
    end.tet = crossing->tet;
    end.weights = locator_.weights(end.tet, x_);
  } else {
    x_ = target;
  }
  at_ = end;
  advance_ = (x_ - x_start_).norm();
  stale_ = !tissue_.move_tip(at_, x_);
}

void Cut::march_before_surface(double advance) {
  march(advance);
  if (blocked_) march(0.0);
  blocked_ = false;
}

void Cut::enter(Index tet) {
  if (tet != at_.tet) {
    at_.tet = tet;
    at_.weights = locator_.weights(tet, x_);
    take_compliance();
  }
  count_from_here();
}

}  // namespace stylet

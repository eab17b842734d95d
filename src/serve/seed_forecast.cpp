// SPDX-License-Identifier: GPL-3.0-or-later
#include "seed_forecast.hpp"

#include <algorithm>

namespace stylet::serve {

namespace {

constexpr double kExact_mm = 0.02;   // nearer, the same point is watched on
constexpr double kKnown_mm = 0.5;    // from the place; farther, the search has not found the point
constexpr int kMostUnanswered = 60;  // pictures; then the search begins anew at the place itself
constexpr double kLeastStep = 0.1;

}  // namespace

void SeedForecast::aim(const std::optional<Places>& now) {
  const bool is_lost = ++unanswered_ > kMostUnanswered;
  if (!now || !x_ || is_lost) *this = {};
  if (now && !x_) x_ = now->place;
  now_ = now;
}

bool SeedForecast::take(const Vec3& now) {
  if (!now_ || !x_) return false;
  unanswered_ = 0;
  const Vec3 off = now_->place - now;
  // Right beside the needle the displacement changes within its radius, and full steps may overshoot.
  const bool overshot = off_ && off.dot(*off_) < 0.0;
  step_ = overshot ? std::max(kLeastStep, 0.5 * step_) : std::min(1.0, 1.3 * step_);
  off_ = off;
  if (off.norm() < kExact_mm) return false;
  *x_ += step_ * off;
  return true;
}

std::optional<Vec3> SeedForecast::rest() const { return off_ && off_->norm() < kKnown_mm ? x_ : std::nullopt; }

std::optional<double> SeedForecast::off_mm() const {
  const auto found = rest();
  if (!found || !now_) return std::nullopt;
  return (*found - now_->straight).norm();
}

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pick_up.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::serve {

DeviceInput PickUp::read(const DeviceTime& time) noexcept {
  DeviceInput input = handle_->read(time);
  bool is_away = false;
  if (input.valid) {
    const Pose now = pose(input.pose);
    const double mm = (now.origin - last_.origin).norm();
    const double cosine = (now.rotation * Vec3::UnitZ()).dot(last_.rotation * Vec3::UnitZ());
    const double deg = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
    is_away = mm > kNear_mm || deg > kNear_deg;
    away_mm_ = mm;
    away_deg_ = deg;
    input.valid = !is_away;
    // While paused the needle stays, and so does the place at which it has to be taken up.
    if (input.valid && time.simulated_s > last_s_) last_ = now;
  }
  is_away_ = is_away;
  last_s_ = time.simulated_s;
  return input;
}

std::optional<PickUp::Away> PickUp::away() const {
  if (!is_away_) return std::nullopt;
  return Away{away_mm_, away_deg_};
}

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pick_up.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::serve {

DeviceInput PickUp::read(const DeviceTime& time) noexcept {
  DeviceInput input = handle_->read(time);
  is_away_ = false;
  if (!input.valid) return input;
  const Pose now = pose(input.pose);
  const double mm = (now.origin - last_.origin).norm();
  const double cosine = (now.rotation * Vec3::UnitZ()).dot(last_.rotation * Vec3::UnitZ());
  const double deg = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
  input.valid = mm <= kNear_mm && deg <= kNear_deg;
  if (!input.valid) {
    away_mm_ = mm;
    away_deg_ = deg;
    is_away_ = true;
  } else if (time.simulated_s > last_s_) {  // while paused the needle stays, and so does where it has to be taken up
    last_ = now;
  }
  last_s_ = time.simulated_s;
  return input;
}

std::optional<PickUp::Away> PickUp::away() const {
  if (!is_away_) return std::nullopt;
  return Away{away_mm_, away_deg_};
}

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/guide_change.hpp"

namespace stylet {

void GuideChange::begin(const Mat3& change, std::span<const PointLoad> loads, const Vec3& motion) {
  stiffer_ = change * softening(change);
  motion_ = motion;
  for (std::size_t c = 0; c < loads.size(); ++c) before_.segment<3>(3 * static_cast<Eigen::Index>(c)) = loads[c].force;
}

Vec3 GuideChange::force(std::span<const PointLoad> loads) const {
  if (stiffer_.isZero(0.0)) return Vec3::Zero();
  Vec3 motion = motion_;
  for (std::size_t c = 0; c < loads.size(); ++c) {
    const auto at = 3 * static_cast<Eigen::Index>(c);
    motion.noalias() += by_hole_.block<3, 3>(3 + at, 0).transpose() * (loads[c].force - before_.segment<3>(at));
  }
  return -stiffer_ * motion;
}

}  // namespace stylet

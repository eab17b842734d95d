// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/gland_watch.hpp"

#include <algorithm>
#include <numbers>

namespace stylet {

namespace {

constexpr double kResidualAfter_s = 1.0;
constexpr double kRounding_s = 1e-9;
constexpr double kDegrees = 180.0 / std::numbers::pi;

}  // namespace

bool GlandWatch::is_target(const std::string& region) const {
  return std::find(targets_.begin(), targets_.end(), region) != targets_.end();
}

void GlandWatch::notice(const Event& event) {
  if (event.kind == EventKind::puncture && is_target(event.region) && !motion_.shift_at_break_mm)
    motion_.shift_at_break_mm = last_shift_mm_;
  if (event.kind == EventKind::withdrawn) withdrawn_s_ = event.time_s;
  if (event.kind == EventKind::skin_contact || event.kind == EventKind::re_entered) {
    withdrawn_s_.reset();
    motion_.shift_residual_mm.reset();
  }
}

GlandStep GlandWatch::add(const Step& step, std::span<const Event> events, const VolumeMotion& motion, bool at_rest,
                          bool deepest) {
  for (const Event& event : events) notice(event);
  GlandStep now{step.time_s, step.base_depth_mm, motion.shift_mm, kDegrees * motion.rotation_rad};
  if (advancing_ && now.shift_mm.norm() > motion_.shift_max_mm.norm()) {
    motion_.shift_max_mm = now.shift_mm;
    motion_.rotation_deg = now.rotation_deg;
    motion_.base_mm = motion.third_mm[VolumeMotion::superior];
    motion_.mid_mm = motion.third_mm[VolumeMotion::middle];
    motion_.apex_mm = motion.third_mm[VolumeMotion::inferior];
    motion_.volume_change_percent = 100.0 * motion.dilation;
  }
  if (deepest) {
    motion_.shift_in_place_mm = now.shift_mm;
    advancing_ = false;
  }
  if (withdrawn_s_ && !motion_.shift_residual_mm && step.time_s >= *withdrawn_s_ + kResidualAfter_s - kRounding_s)
    motion_.shift_residual_mm = now.shift_mm;
  last_shift_mm_ = now.shift_mm;
  at_rest_ = at_rest;
  return now;
}

GlandMotion GlandWatch::result() const {
  GlandMotion result = motion_;
  // Tissue without forces, lasting ones included, is undeformed and stays so: the residual shift is known to be zero.
  if (withdrawn_s_ && !result.shift_residual_mm && at_rest_) result.shift_residual_mm = Vec3::Zero();
  return result;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/guide_meeting.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// Largest number of rounds of the search for the nearest point. A larger number makes a search that fails cost more.
constexpr int kMostRounds = 30;
/// [mm] The nearest point is found when it moves less than this. A larger value makes the force less exact.
constexpr double kFound_mm = 1e-12;
/// [mm] Longest step of the search. A larger value may take a shaft in a loop to another of its passages.
constexpr double kLongestStep_mm = 5.0;
/// [N] The edge of the hole is rounded: up to about this force its stiffness grows with the force. A larger value makes
/// the hole narrower; a smaller one takes more iterations where the shaft touches the edge.
constexpr double kRounded_N = 1.0;
}  // namespace

void GuideMeeting::place(const Vec3& centre, const Vec3& axis) {
  placed_ = true;
  centre_ = centre;
  axis_ = axis;
  found_ = has_held_ = false;
}

/// Finds the arc length at which the shaft is nearest to the centre, starting where it was before.
bool GuideMeeting::find_nearest(const Needle& needle) {
  const double length = needle.length();
  const auto before_plane = [&](double s) { return axis_.dot(centre_ - needle.point(s)); };
  if (!found_) {
    if (before_plane(0.0) < 0.0 || before_plane(length) > 0.0) return false;
    load_.s = std::clamp((centre_ - needle.point(0.0)).norm(), 0.0, length);
  }
  double s = load_.s;
  for (int round = 0; round < kMostRounds; ++round) {
    const AxisPlace at = needle.place(s);
    const double more = std::clamp(at.tangent.dot(centre_ - at.point), -kLongestStep_mm, kLongestStep_mm);
    const double next = std::clamp(s + more, 0.0, length);
    const bool there = std::abs(next - s) < kFound_mm;
    s = next;
    if (there) break;
  }
  load_.s = s;
  found_ = s > 0.0 && s < length;
  return found_;
}

void GuideMeeting::meet(const Needle& needle) {
  push_ = 0.0;
  energy_ = 0.0;
  offset_.setZero();
  load_.force.setZero();
  stiffness_.setZero();
  if (!placed_ || !find_nearest(needle)) {
    has_held_ = false;
    return;
  }
  const auto [point, t] = needle.place(load_.s);
  offset_ = point - centre_;
  offset_ -= t * t.dot(offset_);
  const double d = offset_.norm();
  const double k = hole_.stiffness_N_per_mm;
  const double rounded = std::min(kRounded_N / k, hole_.clearance_mm);
  const double beyond = d - hole_.clearance_mm;
  double along = 0.0;  // stiffness along e
  if (beyond > rounded || rounded == 0.0) {
    push_ = k * beyond;
    along = k;
    energy_ = 0.5 * k * beyond * beyond + k * rounded * rounded / 6.0;
  } else if (beyond > -rounded) {
    const double in = beyond + rounded;
    push_ = k * in * in / (4.0 * rounded);
    along = k * in / (2.0 * rounded);
    energy_ = k * in * in * in / (12.0 * rounded);
  }
  if (!holds()) return;
  has_held_ = true;
  const Vec3 e = d > 0.0 ? Vec3(offset_ / d) : Vec3(Vec3::Zero());
  const double across = d > 0.0 ? push_ / d : k;
  load_.force = -push_ * e;
  stiffness_ = across * (Mat3::Identity() - t * t.transpose()) + (along - across) * e * e.transpose();
}

}  // namespace stylet

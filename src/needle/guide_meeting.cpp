// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/guide_meeting.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// Largest number of rounds of the search for the crossing. A larger number makes a search that fails cost more.
constexpr int kMostRounds = 60;
/// [mm] A point closer to the hole's plane than this counts as on it. A larger value makes the crossing less exact.
constexpr double kOnPlane_mm = 1e-13;
/// Smallest cosine between shaft and axis; a more oblique shaft counts as not running through the hole. A larger value
/// takes a sharply bent needle out of the hole sooner.
constexpr double kMostOblique = 0.1;
}  // namespace

void GuideMeeting::place(const Vec3& centre, const Vec3& axis) {
  placed_ = true;
  centre_ = centre;
  axis_ = axis;
}

/// Finds the arc length where the shaft crosses the plane, by Newton's method with bisection as a safeguard.
bool GuideMeeting::find_crossing(const Needle& needle) {
  const auto before_plane = [&](double s) { return axis_.dot(centre_ - needle.point(s)); };
  double low = 0.0;
  double high = needle.length();
  if (before_plane(low) < 0.0 || before_plane(high) > 0.0) return false;
  double s = std::clamp(load_.s, low, high);
  for (int round = 0; round < kMostRounds; ++round) {
    const AxisPlace at = needle.place(s);
    const double ahead = axis_.dot(centre_ - at.point);
    if (std::abs(ahead) < kOnPlane_mm) break;
    (ahead > 0.0 ? low : high) = s;
    double next = s + ahead / axis_.dot(at.tangent);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == s) break;
    s = next;
  }
  load_.s = s;
  return true;
}

void GuideMeeting::meet(const Needle& needle) {
  crosses_ = false;
  beyond_ = 0.0;
  offset_.setZero();
  load_.force.setZero();
  stiffness_.setZero();
  if (!placed_ || !find_crossing(needle)) return;
  const auto [point, t] = needle.place(load_.s);
  const double cosine = axis_.dot(t);
  if (cosine < kMostOblique) return;
  crosses_ = true;
  const Vec3 away = point - centre_;
  offset_ = away - axis_ * axis_.dot(away);
  const double d = offset_.norm();
  beyond_ = std::max(0.0, d - hole_.clearance_mm);
  if (!holds()) return;

  const Vec3 e = d > 0.0 ? Vec3(offset_ / d) : Vec3(Vec3::Zero());
  const double across = d > 0.0 ? beyond_ / d : 1.0;  // stiffness perpendicular to e / stiffness along e
  const Mat3 in_plane = Mat3::Identity() - axis_ * axis_.transpose();
  const Mat3 H = hole_.stiffness_N_per_mm * (across * in_plane + (1.0 - across) * e * e.transpose());
  const Mat3 P = Mat3::Identity() - t * axis_.transpose() / cosine;
  load_.force = -hole_.stiffness_N_per_mm * beyond_ * (P.transpose() * e);
  stiffness_ = P.transpose() * H * P;
}

}  // namespace stylet

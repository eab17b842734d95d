// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/igtl/picture.hpp"

namespace stylet::igtl {

namespace {

/// Turns `rotation` by the smallest rotation that takes its z axis to `direction`; does nothing if `direction` is zero.
void carry(Eigen::Quaterniond& rotation, const Vec3& direction) {
  if (!(direction.squaredNorm() > 1e-18)) return;
  rotation = (Eigen::Quaterniond::FromTwoVectors(rotation * Vec3::UnitZ(), direction) * rotation).normalized();
}

}  // namespace

Pose tip_pose(const Pose& base, std::span<const Triple> centreline) {
  if (centreline.size() < 2) return base;
  Pose tip = base;
  for (std::size_t k = 1; k < centreline.size(); ++k)
    carry(tip.rotation, vec3(centreline[k]) - vec3(centreline[k - 1]));
  const std::size_t n = centreline.size() - 1;
  tip.origin = vec3(centreline[n]);
  // The last chord is the tangent half a spacing before the tip. This difference formula gives the tangent at the tip,
  // to second order.
  if (n >= 2) carry(tip.rotation, 3.0 * vec3(centreline[n]) - 4.0 * vec3(centreline[n - 1]) + vec3(centreline[n - 2]));
  return tip;
}

Picture picture_of(const Snapshot& snapshot, const DeviceSnapshot& device) {
  Picture p;
  p.time_s = snapshot.step.time_s;
  p.base = plain(snapshot.step.base);
  p.tip = plain(tip_pose(snapshot.step.base, snapshot.centreline));
  p.on_hand = device.sent;
  for (std::size_t k = 0; k < Picture::kShaft; ++k)
    p.shaft[k] = snapshot.centreline[k * (Snapshot::kCentreline - 1) / (Picture::kShaft - 1)];
  return p;
}

}  // namespace stylet::igtl

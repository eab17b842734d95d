// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/snapshot.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace stylet::igtl {

/// The state of the needle that a link sends: plain data in Stylet's frame (LPS).
struct Picture {
  static constexpr std::size_t kShaft = 10;
  double time_s = 0.0;  ///< simulated time
  PlainPose base;
  PlainPose tip;                       ///< see tip_pose()
  PlainWrench on_hand;                 ///< force and torque of needle and tissue on the hand, about the base point
  std::array<Triple, kShaft> shaft{};  ///< [mm] LPS, points on the centreline, base to tip
  bool has_probe = false;              ///< whether there is an ultrasound probe, whose pose is then sent
  PlainPose probe;
};

/// The pose of the tip. Its axes result from transporting the axes of the base along the centreline without twist:
/// local z is the tangent at the tip, and the bevel keeps its side.
/// @param centreline [mm] LPS, base to tip, evenly spaced. If it has no length, the pose of the base is returned.
[[nodiscard]] Pose tip_pose(const Pose& base, std::span<const Triple> centreline);

/// Makes the picture of a runner's latest snapshots. Its force is the force that the runner sent to its device:
/// limited, and zero where the hand's samples are invalid or old.
[[nodiscard]] Picture picture_of(const Snapshot& snapshot, const DeviceSnapshot& device);

/// A deformed triangulated surface.
struct Surface {
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  std::vector<std::array<float, 3>> points;  ///< [mm] LPS
  std::shared_ptr<const Triangles>
      triangles;  ///< indices of the corners in `points`; shared, because they do not change
};

}  // namespace stylet::igtl

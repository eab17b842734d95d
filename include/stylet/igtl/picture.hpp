// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/snapshot.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace stylet::igtl {

/// What a link shows of the needle: plain data, in our own frame.
struct Picture {
  static constexpr std::size_t kShaft = 10;
  double time_s = 0.0;  ///< simulated
  PlainPose base;
  PlainPose tip;                       ///< as tip_pose
  PlainWrench on_hand;                 ///< what needle and tissue exert on the hand, about the base point
  std::array<Triple, kShaft> shaft{};  ///< [mm] LPS, on the centreline, base to tip
};

/// Where the tip is and how it lies: the base's axes carried along the centreline without twist, so that local z is the
/// tangent at the tip and the bevel keeps its side.
/// @param centreline [mm] LPS, base to tip, evenly spaced; the base's own pose where it has no length
[[nodiscard]] Pose tip_pose(const Pose& base, std::span<const Triple> centreline);

/// The picture of a runner's latest snapshots. Its force is the one the runner let through to its device: limited, and
/// nothing where the hand's samples are invalid or old.
[[nodiscard]] Picture picture_of(const Snapshot& snapshot, const DeviceSnapshot& device);

/// A deformed surface.
struct Surface {
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  std::vector<std::array<float, 3>> points;    ///< [mm] LPS
  std::shared_ptr<const Triangles> triangles;  ///< corners, numbers of points; shared, since they stay the same
};

}  // namespace stylet::igtl

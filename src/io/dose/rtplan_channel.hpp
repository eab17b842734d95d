// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet::detail {

/// One point of a channel's control point sequence (300A,02D0).
struct ControlPoint {
  Vec3 at_mm = Vec3::Zero();  ///< ControlPoint3DPosition (300A,02D4)
  bool has_place = false;     ///< whether the file gives the position
  double weight = 0.0;        ///< CumulativeTimeWeight (300A,02D6); 0 where it is missing
  std::optional<Vec3> axis;   ///< ControlPointOrientation (300A,0412), a unit vector
};

/// A place where a source rests, from the control points of one channel.
struct RestingPlace {
  Vec3 at_mm = Vec3::Zero();
  std::optional<Vec3> axis;
  double weight = 0.0;  ///< part of the channel's cumulative weight
};

/// Finds the places where the source of a channel rests. The weight between two points at one place belongs to that
/// place; the weight between two places is shared by them, because the source moves. Some systems let the weight start
/// at 0 again at each place; then each place has its own. Points without any weight that lie
/// about 1 mm from a seed say its direction where the file has no orientation.
/// @param seeds whether each place holds a seed of its own: then weights only say whether there is one, and a channel
///   without any weight has a seed at its first place and at each place that is not next to one
/// @param where file and channel, for messages
/// Errors: weights that decrease, except behind a seed; a point with weight but without a position.
Result<std::vector<RestingPlace>> resting_places(const std::vector<ControlPoint>& points, bool seeds,
                                                 const std::string& where);

}  // namespace stylet::detail

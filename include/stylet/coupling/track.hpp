// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"

#include <vector>

namespace stylet {

/// The path a needle has cut, in material coordinates, and the places on it where needle and tissue hold each other.
struct Track {
  /// A tissue point the shaft can hold.
  struct Mark {
    double xi = 0.0;        ///< [mm] distance from the entry along the track
    Vec3 x = Vec3::Zero();  ///< [mm] LPS, undeformed
    MaterialPoint at;
    int region = -1;
    int point = -1;  ///< number in TrackCompliance, -1 while not represented there
  };

  Vec3 entry = Vec3::Zero();  ///< where the tip first touched [mm] LPS, undeformed
  Vec3 entry_direction = Vec3::UnitZ();
  std::vector<Mark> marks;  ///< ordered by xi
  Vec3 end = Vec3::Zero();  ///< deepest point reached, undeformed
  MaterialPoint end_at;     ///< its place; the tetrahedron before the far surface where the track is open
  double end_xi = 0.0;
  bool open = false;         ///< the track leaves the tissue through the far side: nothing to push against
  double air_from_xi = 0.0;  ///< where it left
};

}  // namespace stylet

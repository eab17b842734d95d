// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"

#include <vector>

namespace stylet {

/// The path that a needle has cut, in undeformed coordinates, and the marks on it at which the shaft can have contacts.
struct Track {
  /// A place on the track at which the shaft has, or can have, a contact.
  struct Mark {
    double xi = 0.0;        ///< [mm] arc length along the track from the entry
    Vec3 x = Vec3::Zero();  ///< [mm] LPS, undeformed place
    MaterialPoint at;
    int region = -1;
    int point = -1;  ///< number of the point in ContactCompliance; −1 while it has none
  };

  Vec3 entry = Vec3::Zero();  ///< [mm] LPS, undeformed place where the tip first touched the tissue
  Vec3 entry_direction = Vec3::UnitZ();
  std::vector<Mark> marks;  ///< in ascending order of xi
  Vec3 end = Vec3::Zero();  ///< [mm] LPS, undeformed; the deepest point reached
  /// Element and weights of `end`; of an open track, the last element before the far surface.
  MaterialPoint end_at;
  double end_xi = 0.0;
  bool open = false;         ///< whether the track leaves the tissue through the far side, where the tip has nothing to
                             ///< push against
  double air_from_xi = 0.0;  ///< [mm] arc length at which an open track leaves the tissue
};

}  // namespace stylet

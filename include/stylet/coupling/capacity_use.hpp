// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

namespace stylet {

/// Room that is set aside before the first step, since no step allocates, and the most of it that was ever in use.
struct CapacityUse {
  int most = 0;
  int room = 0;

  void note(int used) { most = std::max(most, used); }
};

/// Of an Insertion, since it was made.
struct CapacityUses {
  CapacityUse contacts;     ///< on the shaft; one more is flagged, out_of_contacts
  CapacityUse spare_nodes;  ///< whose compliance came beyond what was there before; for more the furthest go
  CapacityUse tracks;       ///< of earlier insertions; for one more the oldest is forgotten
  CapacityUse events;       ///< of one step; further ones are not told
};

}  // namespace stylet

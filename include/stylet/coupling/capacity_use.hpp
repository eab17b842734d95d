// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

namespace stylet {

/// Room that is allocated before the first step, because no step allocates, and the largest part of it ever in use.
struct CapacityUse {
  int most = 0;  ///< largest number in use at a time so far
  int room = 0;  ///< number for which memory is allocated

  void note(int used) { most = std::max(most, used); }
};

/// Capacities of an Insertion, with their use since it was constructed.
struct CapacityUses {
  CapacityUse contacts;     ///< shaft contacts; one more sets the flag out_of_contacts
  CapacityUse spare_nodes;  ///< nodes whose compliance was added after the start; one more replaces the node furthest
                            ///< from the tip
  CapacityUse tracks;       ///< tracks of earlier insertions; one more replaces the oldest
  CapacityUse events;       ///< events of one step; further events are dropped
};

}  // namespace stylet

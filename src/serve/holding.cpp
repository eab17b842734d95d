// SPDX-License-Identifier: GPL-3.0-or-later
#include "holding.hpp"

#include <algorithm>

namespace stylet::serve {

void Holding::take(Viewer viewer) {
  if (holder_ == 0) {
    holder_ = viewer;
  } else if (holder_ != viewer && !asks(viewer)) {
    asking_.push_back(viewer);
  }
}

void Holding::release(Viewer viewer) {
  if (holder_ != viewer) {
    std::erase(asking_, viewer);
    return;
  }
  holder_ = 0;
  if (asking_.empty()) return;
  holder_ = asking_.front();
  asking_.pop_front();
}

bool Holding::leave(Viewer viewer) {
  const bool held = holder_ == viewer;
  release(viewer);
  return held;
}

bool Holding::asks(Viewer viewer) const { return std::find(asking_.begin(), asking_.end(), viewer) != asking_.end(); }

}  // namespace stylet::serve

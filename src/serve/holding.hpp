// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>

namespace stylet::serve {

/// Records which viewer holds the needle and which viewers have asked for it.
class Holding {
 public:
  using Viewer = std::uint64_t;  ///< 0: nobody

  /// Gives the viewer the needle if nobody holds it; otherwise puts the viewer at the end of the queue.
  void take(Viewer viewer);
  /// If the viewer holds the needle, passes it to the first of the queue; otherwise takes the viewer out of the queue.
  void release(Viewer viewer);
  /// Removes a viewer that has disconnected. @return whether the viewer held the needle
  bool leave(Viewer viewer);

  [[nodiscard]] Viewer holder() const { return holder_; }
  [[nodiscard]] bool asks(Viewer viewer) const;
  [[nodiscard]] std::size_t asking() const { return asking_.size(); }

 private:
  Viewer holder_ = 0;
  std::deque<Viewer> asking_;
};

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>

namespace stylet::serve {

/// Who of the viewers holds the needle, and who has asked for it.
class Holding {
 public:
  using Viewer = std::uint64_t;  ///< 0: nobody

  /// The needle, if nobody holds it; else its holder learns of the wish.
  void take(Viewer viewer);
  /// Gives it to who has asked longest. Of who does not hold it: withdraws the wish.
  void release(Viewer viewer);
  /// @return whether the viewer held the needle
  bool leave(Viewer viewer);

  [[nodiscard]] Viewer holder() const { return holder_; }
  [[nodiscard]] bool asks(Viewer viewer) const;
  [[nodiscard]] std::size_t asking() const { return asking_.size(); }

 private:
  Viewer holder_ = 0;
  std::deque<Viewer> asking_;
};

}  // namespace stylet::serve

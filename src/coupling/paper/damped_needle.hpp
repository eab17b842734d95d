// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/paper/anderson.hpp"
#include "stylet/needle/needle.hpp"

#include <vector>

namespace stylet::paper {

/// Bends a needle under given loads, step by step: each load's point is held where it is by a spring, and the shape is
/// accelerated over the steps. At the end the springs carry nothing. Nothing allocates after construction.
class DampedNeedle {
 public:
  /// @param shape_size of Needle::state()
  DampedNeedle(Eigen::Index shape_size, int most_loads);

  /// The loads follow another rule from now on: earlier steps say nothing about the next.
  void restart() { acceleration_.restart(); }
  /// The spring that damps the needle at a load [N/mm] LPS, to be written.
  [[nodiscard]] Mat3& spring(int load) { return springs_[static_cast<std::size_t>(load)]; }
  /// One Newton step of the needle on its springs. @param loads (w) as the springs are numbered
  void bend(Needle& needle, std::span<const PointLoad> loads);

 private:
  Anderson acceleration_;
  VecX before_;                ///< needle's state before the step
  VecX after_;                 ///< the same after it
  std::vector<Mat3> springs_;  ///< [N/mm]
  MatX compliance_;            ///< [mm/N] (3w × 3w) room
  VecX motion_;                ///< [mm] (3w) room
};

}  // namespace stylet::paper

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/paper/anderson.hpp"
#include "stylet/needle/needle.hpp"

#include <vector>

namespace stylet::paper {

/// Bends a needle under given loads, step by step: a spring holds each loaded point at its present place, and the shape
/// is accelerated over the steps. At the end the springs carry no force. Nothing allocates after construction.
class DampedNeedle {
 public:
  /// @param shape_size size of Needle::state()
  DampedNeedle(Eigen::Index shape_size, int most_loads);

  /// Discards earlier steps: the loads follow another rule from now on.
  void restart() { acceleration_.restart(); }
  /// The spring [N/mm] LPS that damps the needle at a load; to be written.
  [[nodiscard]] Mat3& spring(int load) { return springs_[static_cast<std::size_t>(load)]; }
  /// Takes one Newton step of the needle on its springs. @param loads (w) in the order of the springs
  void bend(Needle& needle, std::span<const PointLoad> loads);

 private:
  Anderson acceleration_;
  VecX before_;                ///< Needle::state() before the step
  VecX after_;                 ///< Needle::state() after the step
  std::vector<Mat3> springs_;  ///< [N/mm]
  MatX compliance_;            ///< [mm/N] (3w × 3w) work space
  VecX motion_;                ///< [mm] (3w) work space
};

}  // namespace stylet::paper

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/bar_stiffness.hpp"
#include "needle/block_band.hpp"
#include "needle/tet_segment.hpp"

#include <array>
#include <vector>

namespace stylet::tet {

/// The middle nodes of all segments, eliminated from the equations of a bar: no load acts on them and no other segment
/// knows them, so that each segment by itself leaves a matrix of its two layers only. Segments, layers and unknowns are
/// counted as in TetShape. Nothing allocates after construction.
class MiddleNodes {
 public:
  MiddleNodes(const SegmentMesh& mesh, int segments);

  /// Eliminates the middle nodes of one segment. @param shift part of the material stiffness that is added to it
  /// @return false where the stiffness is found not to be positive definite
  [[nodiscard]] bool eliminate(int segment, const SegmentStiffness& K, double shift);
  /// What the last eliminate() left between two layers of the segment, 0 nearer the base and 1 the next [N/mm]; row ≥
  /// column, and of (0, 0) and (1, 1) the lower triangle counts.
  [[nodiscard]] auto left(int row, int column) const {
    return work_.block<kBlock, kBlock>(kBlock * row, kBlock * column);
  }
  /// Makes all middle nodes unit springs that know no other node.
  void disconnect();

  /// Forward substitution: what the gradient at the middle nodes leaves to the layers 1…n. Its result at the middle
  /// nodes is kept for move().
  /// @param gradient [N] in the order of TetShape::displacement @param layers [N] (15 per segment) written
  void reduce(const VecX& gradient, VecX& layers);
  /// Back substitution: adds the motion of layers and middle nodes to the displacement.
  /// @param layers [mm] (15 per segment) motion of the layers 1…n
  /// @param displacement [mm] in the order of TetShape::displacement
  void move(const VecX& layers, VecX& displacement) const;

 private:
  /// A middle node: its pivot L Lᵀ, and for every neighbour its coupling times L⁻ᵀ.
  struct Eliminated {
    Mat3 L;
    std::array<Mat3, kFirstMiddle> coupling;
  };
  [[nodiscard]] int count() const { return static_cast<int>(neighbours_.size()); }     ///< in one segment
  [[nodiscard]] Eigen::Index unknowns() const { return 3 * (count() + kLayerNodes); }  ///< of one segment
  [[nodiscard]] const Eliminated& eliminated(int segment, int m) const {
    return eliminated_[static_cast<std::size_t>(segment * count() + m)];
  }

  int segments_;
  std::vector<std::vector<int>> neighbours_;  ///< of each middle node, those not eliminated before it
  std::vector<Eliminated> eliminated_;        ///< segment by segment
  VecX reduced_;                              ///< (3 middle nodes per segment) L⁻¹ of the gradient there
  Eigen::Matrix<double, 3 * kMostNodes, 3 * kMostNodes> work_;  ///< stiffness of the segment that is eliminated
};

}  // namespace stylet::tet

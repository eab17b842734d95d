// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/bar_stiffness.hpp"
#include "needle/block_band.hpp"
#include "needle/tet_segment.hpp"

#include <array>
#include <vector>

namespace stylet::tet {

/// Eliminates the middle nodes of all segments from the equations of a bar. No load acts on them and they are not
/// connected to other segments, so each segment by itself reduces to a matrix of its two layers. Segments, layers and
/// unknowns are numbered as in TetShape. Nothing allocates after construction.
class MiddleNodes {
 public:
  MiddleNodes(const SegmentMesh& mesh, int segments);

  /// Eliminates the middle nodes of one segment.
  /// @param shift multiple of the material stiffness that is added
  /// @return false when the stiffness is not positive definite
  [[nodiscard]] bool eliminate(int segment, const SegmentStiffness& K, double shift);
  /// Stiffness that the last eliminate() left between two layers of the segment [N/mm]: 0 is the layer nearer to the
  /// base, 1 the other one. row ≥ column; only the lower triangles of (0, 0) and (1, 1) are valid.
  [[nodiscard]] auto left(int row, int column) const {
    return work_.block<kBlock, kBlock>(kBlock * row, kBlock * column);
  }
  /// Replaces all middle nodes by unit springs that are connected to no other node.
  void disconnect();

  /// Forward substitution: reduces the gradient to the layers 1…n. The intermediate result at the middle nodes is kept
  /// for move().
  /// @param gradient [N] in the order of TetShape::displacement
  /// @param layers output [N] (15 per segment)
  void reduce(const VecX& gradient, VecX& layers);
  /// Back substitution: adds the motion of layers and middle nodes to the displacement.
  /// @param layers [mm] (15 per segment) motion of the layers 1…n
  /// @param displacement [mm] in the order of TetShape::displacement
  void move(const VecX& layers, VecX& displacement) const;

 private:
  /// An eliminated middle node: its pivot L Lᵀ, and its coupling to each neighbour times L⁻ᵀ.
  struct Eliminated {
    Mat3 L;
    std::array<Mat3, kFirstMiddle> coupling;
  };
  /// Number of middle nodes in one segment.
  [[nodiscard]] int count() const { return static_cast<int>(neighbours_.size()); }
  /// Number of unknowns of one segment.
  [[nodiscard]] Eigen::Index unknowns() const { return 3 * (count() + kLayerNodes); }
  [[nodiscard]] const Eliminated& eliminated(int segment, int m) const {
    return eliminated_[static_cast<std::size_t>(segment * count() + m)];
  }

  int segments_;
  std::vector<std::vector<int>> neighbours_;  ///< neighbours of each middle node that are not eliminated before it
  std::vector<Eliminated> eliminated_;        ///< ordered by segment
  VecX reduced_;  ///< (3 middle nodes per segment) L⁻¹ of the gradient at the middle nodes
  /// Stiffness of the segment whose nodes are being eliminated.
  Eigen::Matrix<double, 3 * kMostNodes, 3 * kMostNodes> work_;
};

}  // namespace stylet::tet

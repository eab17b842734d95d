// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/tet_shape.hpp"

#include <vector>

namespace stylet::tet {

/// Stiffness of one segment [N/mm]. The block of nodes i ≥ j is block (i, j) of `material` + `geometric`(i, j) times
/// the unit matrix.
struct SegmentStiffness {
  Eigen::Matrix<double, 3 * kMostNodes, 3 * kMostNodes> material;
  Eigen::Matrix<double, kMostNodes, kMostNodes> geometric;
};

/// Stiffness of a bar of tetrahedra at its current shape, segment by segment, without loads and springs. Nothing
/// allocates after construction.
class BarStiffness {
 public:
  explicit BarStiffness(const TetShape& shape);

  /// Computes the stiffness for the current shape. Does nothing when it is already known for this revision of the
  /// shape, which happens when springs are lent after an attempt without them.
  void assemble(const TetShape& shape);

  [[nodiscard]] const SegmentStiffness& segment(int k) const { return segments_[static_cast<std::size_t>(k)]; }

  /// The whole matrix [N/mm] in the order of TetShape::displacement. For tests; allocates.
  [[nodiscard]] MatX whole(const TetShape& shape) const;

 private:
  static void assemble_segment(const TetShape& shape, int segment, SegmentStiffness& K);

  std::vector<SegmentStiffness> segments_;
  long revision_ = -1;  ///< revision of the shape that segments_ belong to; -1: none
};

}  // namespace stylet::tet

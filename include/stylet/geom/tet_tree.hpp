// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <array>
#include <span>
#include <vector>

namespace stylet {

/// A tree of bounding boxes around the tetrahedra of a mesh. Boxes are halved at the median of the centroids until few
/// tetrahedra are left in each.
class TetTree {
 public:
  explicit TetTree(const TetMesh& mesh);

  /// All tetrahedra, sorted so that the tetrahedra of one leaf, and of neighbouring leaves, are next to each other.
  [[nodiscard]] std::span<const Index> order() const { return order_; }

  /// Calls `look` for the tetrahedra of each leaf (a range of order()) for which `meets` returns true, for its own box
  /// and for all boxes around it. Does not allocate.
  /// @param meets (const Eigen::AlignedBox3d&) → bool: whether the box can contain what is searched for
  /// @param look (std::span<const Index> tets) → bool: whether to continue
  template <class Meets, class Look>
  void visit(Meets&& meets, Look&& look) const {
    // Halving at the median keeps the tree's depth below 32 for every mesh whose tetrahedra an Index can number.
    std::array<Index, 64> stack{};
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Box& at = boxes_[static_cast<std::size_t>(stack[--top])];
      if (!meets(at.box)) continue;
      if (at.count < 0) {
        stack[top++] = at.first + 1;
        stack[top++] = at.first;
      } else if (!look(std::span(order_).subspan(static_cast<std::size_t>(at.first),
                                                 static_cast<std::size_t>(at.count)))) {
        return;
      }
    }
  }

 private:
  struct Box {
    Eigen::AlignedBox3d box;
    /// Leaf: range in order_; inner box: count = -1, first = left child (the right child is first + 1).
    Index first, count;
  };
  std::vector<Box> boxes_;
  std::vector<Index> order_;
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <array>
#include <span>
#include <vector>

namespace stylet {

/// Boxes around the tetrahedra of a mesh, halved at the median of their centroids until a few are in each.
class TetTree {
 public:
  explicit TetTree(const TetMesh& mesh);

  /// All tetrahedra, those of a leaf side by side, and next to them those of the leaves beside it.
  [[nodiscard]] std::span<const Index> order() const { return order_; }

  /// Passes the tetrahedra of every leaf, a part of order(), whose box, as all those around it, `meets` what is looked
  /// for. Does not allocate.
  /// @param meets (const Eigen::AlignedBox3d&) → bool
  /// @param look (std::span<const Index> tets) → bool, whether to go on
  template <class Meets, class Look>
  void visit(Meets&& meets, Look&& look) const {
    // Halving at the median keeps the tree's depth under 32 for any mesh an Index can count.
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
    Index first, count;  ///< leaf: range in order_; inner: count = -1, first = left child (right = first + 1)
  };
  std::vector<Box> boxes_;
  std::vector<Index> order_;
};

}  // namespace stylet

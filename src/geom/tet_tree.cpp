// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/tet_tree.hpp"

#include <algorithm>
#include <numeric>

namespace stylet {

namespace {
constexpr Index kLeafSize = 6;
}

TetTree::TetTree(const TetMesh& mesh) {
  const Index m = mesh.tet_count();
  order_.resize(static_cast<std::size_t>(m));
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centroid(static_cast<std::size_t>(m));
  for (Index t = 0; t < m; ++t) {
    centroid[t].setZero();
    for (const Index a : mesh.tets[t]) centroid[t] += 0.25 * mesh.nodes[a];
  }

  const auto box_of = [&](Index first, Index count) {
    Eigen::AlignedBox3d box;
    for (Index i = first; i < first + count; ++i) {
      for (const Index a : mesh.tets[order_[i]]) box.extend(mesh.nodes[a]);
    }
    const Vec3 margin = Vec3::Constant(1e-8 * (box.isEmpty() ? 0.0 : box.diagonal().norm()));
    return Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
  };
  boxes_.push_back({box_of(0, m), 0, m});
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Index first = boxes_[i].first;
    const Index count = boxes_[i].count;
    if (count <= kLeafSize) continue;
    int axis = 0;
    boxes_[i].box.sizes().maxCoeff(&axis);
    const Index half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                     [&](Index p, Index q) {
                       return centroid[p][axis] != centroid[q][axis] ? centroid[p][axis] < centroid[q][axis] : p < q;
                     });
    boxes_[i].first = static_cast<Index>(boxes_.size());
    boxes_[i].count = -1;
    boxes_.push_back({box_of(first, half), first, half});
    boxes_.push_back({box_of(first + half, count - half), first + half, count - half});
  }
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/split_mesh.hpp"

namespace stylet {

SplitMesh::SplitMesh(const Locator& locator, int capacity)
    : locator_(&locator), base_nodes_(locator.mesh().node_count()), capacity_(static_cast<std::size_t>(capacity)) {
  positions_.reserve(capacity_);
  cells_.reserve(capacity_ * 8 + 2);
  root_.assign(locator.mesh().tets.size(), -1);
  split_tets_.reserve(capacity_ * 2);
}

Vec3 SplitMesh::position(Index vertex) const {
  return vertex < base_nodes_ ? locator_->mesh().nodes[static_cast<std::size_t>(vertex)]
                              : positions_[static_cast<std::size_t>(vertex - base_nodes_)];
}

Vec4 SplitMesh::weights(const Leaf& leaf, const Vec3& x) const {
  const Vec3 origin = position(leaf.vertices[0]);
  Mat3 edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = position(leaf.vertices[static_cast<std::size_t>(i + 1)]) - origin;
  const Vec3 tail = edges.inverse() * (x - origin);
  return {1.0 - tail.sum(), tail.x(), tail.y(), tail.z()};
}

Eigen::Matrix<double, 3, 4> SplitMesh::gradients(const Leaf& leaf) const {
  const Vec3 origin = position(leaf.vertices[0]);
  Mat3 edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = position(leaf.vertices[static_cast<std::size_t>(i + 1)]) - origin;
  const Mat3 inverse = edges.inverse();
  Eigen::Matrix<double, 3, 4> g;
  for (int i = 0; i < 3; ++i) g.col(i + 1) = inverse.row(i).transpose();
  g.col(0) = -(g.col(1) + g.col(2) + g.col(3));
  return g;
}

double SplitMesh::volume(const Leaf& leaf) const {
  const Vec3 origin = position(leaf.vertices[0]);
  Mat3 edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = position(leaf.vertices[static_cast<std::size_t>(i + 1)]) - origin;
  return edges.determinant() / 6.0;
}

SplitMesh::Leaf SplitMesh::leaf_at(Index base_tet, const Vec3& x) const {
  Leaf leaf{locator_->mesh().tets[static_cast<std::size_t>(base_tet)], base_tet,
            root_[static_cast<std::size_t>(base_tet)]};
  while (leaf.cell >= 0) {
    const Cell& cell = cells_[static_cast<std::size_t>(leaf.cell)];
    leaf.vertices = cell.vertices;
    if (cell.children == 0) break;
    // The child that contains x is the one in which the smallest weight is largest: right also on shared faces.
    Index best = -1;
    double best_weight = -std::numeric_limits<double>::infinity();
    for (Index child = cell.first_child; child < cell.first_child + cell.children; ++child) {
      const Leaf candidate{cells_[static_cast<std::size_t>(child)].vertices, base_tet, child};
      const double smallest = weights(candidate, x).minCoeff();
      if (smallest > best_weight) {
        best_weight = smallest;
        best = child;
      }
    }
    leaf.cell = best;
  }
  return leaf;
}

Index SplitMesh::cell_of(const Leaf& leaf) {
  if (leaf.cell >= 0) return leaf.cell;
  const Index cell = static_cast<Index>(cells_.size());
  cells_.push_back({leaf.vertices, leaf.base_tet});
  root_[static_cast<std::size_t>(leaf.base_tet)] = cell;
  split_tets_.push_back(leaf.base_tet);
  return cell;
}

void SplitMesh::split(Index parent, Index vertex, int skip) {
  const Cell whole = cells_[static_cast<std::size_t>(parent)];
  cells_[static_cast<std::size_t>(parent)].first_child = static_cast<Index>(cells_.size());
  for (int q = 0; q < 4; ++q) {
    if (q == skip) continue;  // the point lies on the face opposite q: that child would be flat
    Cell child{whole.vertices, whole.base_tet};
    child.vertices[static_cast<std::size_t>(q)] = vertex;
    cells_.push_back(child);
    ++cells_[static_cast<std::size_t>(parent)].children;
  }
}

Index SplitMesh::split_inside(const Leaf& leaf, const Vec3& x) {
  if (positions_.size() == capacity_) return -1;
  const Index vertex = base_nodes_ + static_cast<Index>(positions_.size());
  positions_.push_back(x);
  split(cell_of(leaf), vertex, -1);
  return vertex;
}

Index SplitMesh::split_face(const Leaf& one, int local1, const Leaf& two, int local2, const Vec3& x) {
  if (positions_.size() == capacity_) return -1;
  const Index vertex = base_nodes_ + static_cast<Index>(positions_.size());
  positions_.push_back(x);
  split(cell_of(one), vertex, local1);
  if (two.base_tet >= 0) split(cell_of(two), vertex, local2);
  return vertex;
}

void SplitMesh::reset() {
  for (const Index tet : split_tets_) root_[static_cast<std::size_t>(tet)] = -1;
  split_tets_.clear();
  cells_.clear();
  positions_.clear();
}

TetMesh SplitMesh::materialise() const {
  const TetMesh& base = locator_->mesh();
  TetMesh mesh;
  mesh.nodes = base.nodes;
  mesh.nodes.insert(mesh.nodes.end(), positions_.begin(), positions_.end());
  mesh.regions = base.regions;
  for (Index t = 0; t < base.tet_count(); ++t) {
    if (root_[static_cast<std::size_t>(t)] >= 0) continue;
    mesh.tets.push_back(base.tets[static_cast<std::size_t>(t)]);
    mesh.tet_region.push_back(base.tet_region[static_cast<std::size_t>(t)]);
  }
  for (const Cell& cell : cells_) {
    if (cell.children > 0) continue;
    mesh.tets.push_back(cell.vertices);
    mesh.tet_region.push_back(base.tet_region[static_cast<std::size_t>(cell.base_tet)]);
  }
  return mesh;
}

}  // namespace stylet

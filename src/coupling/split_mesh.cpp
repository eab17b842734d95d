// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/split_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// Largest weight of the opposite node with which a point still counts as on a face.
constexpr double kOnFace = 1e-4;

/// Moves the node's place in a leaf to the nearest face.
/// @return whether it was within kOnFace of that face
bool put_on_face(SplitMesh::Part& part) {
  const double off = part.weights.cwiseAbs().minCoeff(&part.opposite);
  part.weights[part.opposite] = 0.0;
  part.weights /= part.weights.sum();
  return off <= kOnFace;
}

/// Whether the faces of the two parts have the same vertices.
bool share_face(const SplitMesh::Part& one, const SplitMesh::Part& two) {
  for (int q = 0; q < 4; ++q) {
    if (q == two.opposite) continue;
    const auto found =
        std::find(one.leaf.vertices.begin(), one.leaf.vertices.end(), two.leaf.vertices[static_cast<std::size_t>(q)]);
    if (found == one.leaf.vertices.end() || found - one.leaf.vertices.begin() == one.opposite) return false;
  }
  return true;
}
}  // namespace

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
    // The child that contains x is the one whose smallest weight of x is largest, which is also right on shared faces.
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

std::optional<SplitMesh::Place> SplitMesh::place_inside(Index base_tet, const Vec3& x, double smallest) const {
  Part part{.leaf = leaf_at(base_tet, x)};
  part.weights = weights(part.leaf, x);
  if (part.weights.minCoeff() < smallest) return std::nullopt;
  return Place{.x = x, .part = {part}, .count = 1};
}

std::optional<SplitMesh::Place> SplitMesh::place_on_face(Index base_tet, const Vec3& x, const Vec3& travel,
                                                         double smallest) const {
  const Vec3 nudge = 1e-6 * std::cbrt(std::abs(tet_volume(locator_->mesh(), base_tet))) * travel.normalized();
  Place place{.x = x};
  for (const Vec3& beside : {Vec3{x - nudge}, Vec3{x + nudge}}) {
    const auto found = locator_->find(beside, base_tet);
    if (!found) continue;
    Part& part = place.part[static_cast<std::size_t>(place.count++)];
    part.leaf = leaf_at(found->tet, beside);
    part.weights = weights(part.leaf, x);
    if (!put_on_face(part)) return std::nullopt;
  }
  if (place.count == 0) return std::nullopt;
  const auto& [one, two] = place.part;
  // A path along a face has the same leaf on both sides.
  if (place.count == 2 && (two.leaf.vertices == one.leaf.vertices || !share_face(one, two))) return std::nullopt;
  for (int q = 0; q < 4; ++q) {
    if (q != one.opposite && one.weights[q] < smallest) return std::nullopt;
  }
  return place;
}

Index SplitMesh::cell_of(const Leaf& leaf) {
  if (leaf.cell >= 0) return leaf.cell;
  const Index cell = static_cast<Index>(cells_.size());
  cells_.push_back({leaf.vertices, leaf.base_tet});
  root_[static_cast<std::size_t>(leaf.base_tet)] = cell;
  split_tets_.push_back(leaf.base_tet);
  return cell;
}

void SplitMesh::split_cell(Index parent, Index vertex, int skip) {
  const Cell whole = cells_[static_cast<std::size_t>(parent)];
  cells_[static_cast<std::size_t>(parent)].first_child = static_cast<Index>(cells_.size());
  for (int q = 0; q < 4; ++q) {
    if (q == skip) continue;  // the node lies on the face opposite q, and that child would be flat
    Cell child{whole.vertices, whole.base_tet};
    child.vertices[static_cast<std::size_t>(q)] = vertex;
    cells_.push_back(child);
    ++cells_[static_cast<std::size_t>(parent)].children;
  }
}

Index SplitMesh::split(const Place& place) {
  if (positions_.size() == capacity_) return -1;
  const Index vertex = base_nodes_ + static_cast<Index>(positions_.size());
  positions_.push_back(place.x);
  for (const Part& part : place.parts()) split_cell(cell_of(part.leaf), vertex, part.opposite);
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/paper/adapted_mesh.hpp"

#include <algorithm>

namespace stylet::paper {

AdaptedMesh::AdaptedMesh(const Locator& base) : base_(&base) {
  const TetMesh& mesh = base.mesh();
  on_boundary_.assign(mesh.nodes.size(), false);
  for (const auto* faces : {&base.topology().boundary, &base.topology().interfaces})
    for (const Face& face : *faces)
      for (const Index node : face.nodes) on_boundary_[static_cast<std::size_t>(node)] = true;
  reset();
}

void AdaptedMesh::reset() {
  const TetMesh& mesh = base_->mesh();
  positions_ = mesh.nodes;
  on_boundary_.resize(positions_.size());
  around_ = base_->topology().node_tets;
  parts_.assign(mesh.tets.size(), {});
  elements_.clear();
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    Element element{.nodes = mesh.tets[static_cast<std::size_t>(t)], .base_tet = t};
    shape(element);
    element.first_volume = element.volume;
    elements_.push_back(element);
  }
}

void AdaptedMesh::shape(Element& element) const {
  const auto x = [&](int i) { return position(element.nodes[static_cast<std::size_t>(i)]); };
  Mat3 edges;
  edges << x(1) - x(0), x(2) - x(0), x(3) - x(0);
  element.volume = edges.determinant() / 6.0;
  // Rows of the inverse are the gradients of weights 1 … 3.
  const Vec3 a = edges.col(1).cross(edges.col(2));
  const Vec3 b = edges.col(2).cross(edges.col(0));
  const Vec3 c = edges.col(0).cross(edges.col(1));
  element.gradients.col(1) = a / (6.0 * element.volume);
  element.gradients.col(2) = b / (6.0 * element.volume);
  element.gradients.col(3) = c / (6.0 * element.volume);
  element.gradients.col(0) = -(element.gradients.col(1) + element.gradients.col(2) + element.gradients.col(3));
  element.offset = -(element.gradients.transpose() * x(0));
  element.offset[0] += 1.0;
}

Index AdaptedMesh::find(const Vec3& x, Index hint) const {
  constexpr double inside = -1e-10;
  constexpr double almost = -1e-6;
  Index best = -1;
  double largest = almost;
  const auto look_at = [&](Index e) {
    const Element& candidate = element(e);
    if (!candidate.present) return;
    const double smallest = candidate.weights(x).minCoeff();
    if (smallest <= largest) return;
    largest = smallest;
    best = e;
  };
  if (hint >= 0) {
    const auto& parts = parts_[static_cast<std::size_t>(hint)];
    if (parts.empty()) {
      look_at(hint);
    } else {
      for (const Index e : parts) look_at(e);
    }
    if (largest >= inside) return best;
  }
  for (Index e = 0; e < static_cast<Index>(elements_.size()); ++e) look_at(e);
  return best;
}

std::optional<AdaptedMesh::Change> AdaptedMesh::move_node(Index node, const Vec3& to) {
  Change change;
  change.node = node;
  Vec3& position = positions_[static_cast<std::size_t>(node)];
  const Vec3 from = position;
  position = to;
  std::vector<Index> star;
  for (const Index e : elements_around(node)) {
    Element deformed = element(e);
    shape(deformed);
    if (!(deformed.volume > kSmallestShare * element(e).first_volume)) {
      position = from;
      return std::nullopt;
    }
    star.push_back(e);
    change.before.push_back(element(e));
    change.after.push_back(deformed);
  }
  for (std::size_t k = 0; k < star.size(); ++k) elements_[static_cast<std::size_t>(star[k])] = change.after[k];
  return change;
}

Index AdaptedMesh::put(const std::array<Index, 4>& nodes, Index base_tet) {
  const auto e = static_cast<Index>(elements_.size());
  Element element{.nodes = nodes, .base_tet = base_tet};
  shape(element);
  element.first_volume = element.volume;
  elements_.push_back(element);
  for (const Index node : nodes) around_[static_cast<std::size_t>(node)].push_back(e);
  parts_[static_cast<std::size_t>(base_tet)].push_back(e);
  return e;
}

void AdaptedMesh::take(Index e, Change& change) {
  Element& element = elements_[static_cast<std::size_t>(e)];
  change.before.push_back(element);
  element.present = false;
  for (const Index node : element.nodes) std::erase(around_[static_cast<std::size_t>(node)], e);
  std::erase(parts_[static_cast<std::size_t>(element.base_tet)], e);
}

/// Makes one child for each vertex of an element, except vertex `skip`, with the new node in the vertex's place.
void AdaptedMesh::split(Index e, int skip, Change& change) {
  const Element whole = element(e);
  take(e, change);
  for (int i = 0; i < 4; ++i) {
    if (i == skip) continue;
    auto nodes = whole.nodes;
    nodes[static_cast<std::size_t>(i)] = change.node;
    change.after.push_back(element(put(nodes, whole.base_tet)));
  }
}

AdaptedMesh::Change AdaptedMesh::split_inside(Index e, const Vec3& x) { return split_face(e, -1, -1, -1, x); }

AdaptedMesh::Change AdaptedMesh::split_face(Index first, int local1, Index second, int local2, const Vec3& x) {
  Change change;
  change.node = node_count();
  positions_.push_back(x);
  around_.emplace_back();
  on_boundary_.push_back(false);
  split(first, local1, change);
  if (second >= 0) split(second, local2, change);
  return change;
}

TetMesh AdaptedMesh::materialise() const {
  TetMesh mesh;
  mesh.nodes = positions_;
  mesh.regions = base_->mesh().regions;
  for (const Element& element : elements_) {
    if (!element.present) continue;
    mesh.tets.push_back(element.nodes);
    mesh.tet_region.push_back(base_->mesh().tet_region[static_cast<std::size_t>(element.base_tet)]);
  }
  return mesh;
}

}  // namespace stylet::paper

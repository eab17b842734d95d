// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/paper/inverse_compliance.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::paper {

InverseCompliance::InverseCompliance(std::shared_ptr<const Tissue> tissue, const Locator& locator,
                                     std::shared_ptr<const MatX> initial, DenseInverse::Engine engine, bool move_nodes,
                                     int capacity)
    : tissue_(std::move(tissue)),
      locator_(&locator),
      mesh_(locator),
      inverse_(engine, std::move(initial), capacity),
      move_nodes_(move_nodes),
      capacity_(capacity) {
  points_of_.reserve(static_cast<std::size_t>(capacity) + 1);
  A_ = MatX::Zero(3 * (capacity + 1), 3 * (capacity + 1));
  reset();
}

void InverseCompliance::reset() {
  if (!events_.empty() || first_dof_.empty()) {
    mesh_.reset();
    inverse_.reset();
    first_dof_.resize(tissue_->mesh().nodes.size());
    for (Index node = 0; node < tissue_->mesh().node_count(); ++node)
      first_dof_[static_cast<std::size_t>(node)] = tissue_->first_dof(node);
  }
  events_.clear();
  held_.clear();
  points_of_.assign(1, Point{});
  points_ = 1;
  ++version_;
  A_.setZero();
}

const Material& InverseCompliance::material_of(const AdaptedMesh::Element& element) const {
  return tissue_->material(tissue_->mesh().tet_region[static_cast<std::size_t>(element.base_tet)]);
}

Mat3 InverseCompliance::block(Index a, Index b) const {
  const Index i = first_dof(a);
  const Index j = first_dof(b);
  Mat3 result = Mat3::Zero();
  if (i < 0 || j < 0) return result;
  for (Index r = 0; r < 3; ++r)
    for (Index c = 0; c < 3; ++c) result(r, c) = inverse_(i + r, j + c);
  return result;
}

Mat3 InverseCompliance::compliance(const Point& a, const Point& b) const {
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    if (a.node[i] < 0) continue;
    for (std::size_t j = 0; j < 4; ++j) {
      if (b.node[j] < 0) continue;
      sum +=
          a.weight[static_cast<Eigen::Index>(i)] * b.weight[static_cast<Eigen::Index>(j)] * block(a.node[i], b.node[j]);
    }
  }
  return sum;
}

InverseCompliance::Point InverseCompliance::interpolate(const MaterialPoint& at, const Vec3& x) const {
  Point point;
  point.x = x;
  point.base_tet = at.tet;
  if (move_nodes_) {
    const Index e = mesh_.find(x, at.tet);
    if (e >= 0) {
      point.node = mesh_.element(e).nodes;
      point.weight = mesh_.element(e).weights(x);
      return point;
    }
  }
  point.node = tissue_->mesh().tets[static_cast<std::size_t>(at.tet)];
  point.weight = at.weights;
  return point;
}

/// Applies ΔK of a change to the inverse. All elements have positive volumes before and after, so K stays positive
/// definite and neither the small matrix nor a pivot can be singular.
void InverseCompliance::apply(const AdaptedMesh::Change& change, RemeshEvent& event) {
  std::vector<Index> nodes;
  for (const auto* elements : {&change.before, &change.after})
    for (const auto& element : *elements) nodes.insert(nodes.end(), element.nodes.begin(), element.nodes.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  event.dimension = 3 * static_cast<int>(nodes.size());
  event.elements = static_cast<int>(change.after.size());

  if (change.node == static_cast<Index>(first_dof_.size())) first_dof_.push_back(inverse_.append_node());
  std::erase_if(nodes, [this](Index node) { return first_dof(node) < 0; });
  std::vector<Index> dofs;
  for (const Index node : nodes)
    for (Index axis = 0; axis < 3; ++axis) dofs.push_back(first_dof(node) + axis);
  const auto size = static_cast<Eigen::Index>(dofs.size());
  MatX stiffness = MatX::Zero(size, size);
  const auto add = [&](const AdaptedMesh::Element& element, double sign) {
    std::array<Eigen::Index, 4> place{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto found = std::lower_bound(nodes.begin(), nodes.end(), element.nodes[i]);
      place[i] = found != nodes.end() && *found == element.nodes[i] ? 3 * (found - nodes.begin()) : -1;
    }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const auto row = place[static_cast<std::size_t>(i)];
        const auto column = place[static_cast<std::size_t>(j)];
        if (row < 0 || column < 0) continue;
        stiffness.block<3, 3>(row, column) +=
            sign * element_block(element.gradients, element.volume, material_of(element), i, j);
      }
    }
  };
  for (const auto& element : change.before) add(element, -1.0);
  for (const auto& element : change.after) add(element, 1.0);
  event.condition = inverse_.change(dofs, stiffness);
}

bool InverseCompliance::move_nearest(const MaterialPoint& at, const Vec3& x, RemeshEvent& event) {
  const Index e = mesh_.find(x, at.tet);
  if (e < 0) return false;
  Index nearest = -1;
  double distance = std::numeric_limits<double>::infinity();
  for (const Index node : mesh_.element(e).nodes) {
    const double d = (mesh_.position(node) - x).norm();
    if (d >= distance) continue;
    distance = d;
    nearest = node;
  }
  const bool interpolating = std::any_of(points_of_.begin() + 1, points_of_.end(), [&](const Point& point) {
    return point.interpolated && std::find(point.node.begin(), point.node.end(), nearest) != point.node.end();
  });
  if (std::find(held_.begin(), held_.end(), nearest) != held_.end()) {
    event.refused = RemeshEvent::Refused::held;
  } else if (interpolating) {
    event.refused = RemeshEvent::Refused::contacts;
  } else if (first_dof(nearest) < 0) {
    event.refused = RemeshEvent::Refused::fixed;
  } else if (mesh_.on_boundary(nearest)) {
    event.refused = RemeshEvent::Refused::boundary;
  } else if (const auto change = mesh_.move_node(nearest, x)) {
    event.kind = RemeshEvent::Kind::repositioned;
    event.node = nearest;
    event.moved_mm = distance;
    apply(*change, event);
    return true;
  } else {
    event.refused = RemeshEvent::Refused::inverts;
  }
  return false;
}

ContactCompliance::Refusal InverseCompliance::add_node(const MaterialPoint& at, const Vec3& x, Placement placement,
                                                       const Vec3& travel, RemeshEvent& event) {
  if (!inverse_.has_room()) return Refusal::capacity;
  if (placement == Placement::face) {
    const double nudge = 1e-6 * std::cbrt(std::abs(tet_volume(locator_->mesh(), at.tet)));
    const auto element_at = [&](const Vec3& y) {
      const auto place = locator_->find(y, at.tet);
      return place ? mesh_.find(y, place->tet) : Index{-1};
    };
    Index first = element_at(x - nudge * travel.normalized());
    Index second = element_at(x + nudge * travel.normalized());
    if (first < 0) std::swap(first, second);
    if (first < 0 || first == second) return Refusal::geometry;
    const auto local = [&](Index e) {
      Vec4 weights = mesh_.element(e).weights(x);
      int opposite = 0;
      weights.cwiseAbs().minCoeff(&opposite);
      if (std::abs(weights[opposite]) > 1e-4) return -1;
      weights[opposite] = 1.0;
      return weights.minCoeff() < kSmallestFaceWeight ? -1 : opposite;
    };
    const int local1 = local(first);
    const int local2 = second >= 0 ? local(second) : 0;
    if (local1 < 0 || local2 < 0) return Refusal::geometry;
    if (second >= 0) {  // both must have the same three vertices on the face
      const auto& one = mesh_.element(first).nodes;
      const auto& two = mesh_.element(second).nodes;
      for (int q = 0; q < 4; ++q) {
        if (q == local2) continue;
        const auto found = std::find(one.begin(), one.end(), two[static_cast<std::size_t>(q)]);
        if (found == one.end() || found - one.begin() == local1) return Refusal::geometry;
      }
    }
    event.kind = RemeshEvent::Kind::added_on_face;
    const auto change = mesh_.split_face(first, local1, second, local2, x);
    event.node = change.node;
    apply(change, event);
    return Refusal::none;
  }
  const Index e = mesh_.find(x, at.tet);
  if (e < 0 || mesh_.element(e).weights(x).minCoeff() < kSmallestWeight) return Refusal::geometry;
  event.kind = RemeshEvent::Kind::added_inside;
  const auto change = mesh_.split_inside(e, x);
  event.node = change.node;
  apply(change, event);
  return Refusal::none;
}

ContactCompliance::Added InverseCompliance::add(const MaterialPoint& at, const Vec3& x, Placement placement,
                                                const Vec3& travel) {
  if (points_ > capacity_) return {-1, Refusal::capacity};
  if (placement == Placement::embedded) return finish(interpolate(at, x));
  RemeshEvent event;
  event.point = points_;
  if (!move_nodes_ || !move_nearest(at, x, event)) {
    const Refusal refusal = add_node(at, x, placement, travel, event);
    if (refusal != Refusal::none) return {-1, refusal};
  }
  events_.push_back(event);
  held_.push_back(event.node);
  // The elements around the tip have changed. Interpolated contacts keep their nodes, which have not moved:
  // interpolated in the smaller elements, they would become linear combinations of the nodes added beside them.
  if (Point& tip = points_of_[kTip]; move_nodes_ && tip.base_tet >= 0)
    tip = interpolate({tip.base_tet, locator_->weights(tip.base_tet, tip.x)}, tip.x);
  Point point;
  point.node[0] = event.node;
  point.weight[0] = 1.0;
  point.x = x;
  point.base_tet = at.tet;
  point.interpolated = false;
  points_of_.push_back(point);
  ++points_;
  write_all();
  return {points_ - 1, Refusal::none};
}

ContactCompliance::Added InverseCompliance::finish(const Point& point) {
  points_of_.push_back(point);
  ++points_;
  ++version_;
  write_row(points_ - 1);
  return {points_ - 1, Refusal::none};
}

void InverseCompliance::remove_last_embedded() {
  points_of_.pop_back();
  --points_;
  ++version_;
}

bool InverseCompliance::move_tip(const MaterialPoint& at, const Vec3& x) {
  points_of_[kTip] = interpolate(at, x);
  write_row(kTip);
  return true;
}

void InverseCompliance::write_row(int point) {
  const Point& own = points_of_[static_cast<std::size_t>(point)];
  for (int d = 0; d < points_; ++d) {
    const Mat3 value = compliance(own, points_of_[static_cast<std::size_t>(d)]);
    A_.block<3, 3>(3 * point, 3 * d) = value;
    A_.block<3, 3>(3 * d, 3 * point) = value.transpose();
  }
}

void InverseCompliance::write_all() {
  ++version_;
  for (int point = 0; point < points_; ++point) write_row(point);
}

VecX InverseCompliance::load(const Eigen::Ref<const MatX>& forces) const {
  VecX f = VecX::Zero(3 * mesh_.node_count());
  for (int c = 0; c < points_; ++c) {
    const Point& point = points_of_[static_cast<std::size_t>(c)];
    for (std::size_t i = 0; i < 4; ++i)
      if (point.node[i] >= 0)
        f.segment<3>(3 * point.node[i]) += point.weight[static_cast<Eigen::Index>(i)] * forces.col(c);
  }
  return f;
}

VecX InverseCompliance::nodal_displacement(const Eigen::Ref<const MatX>& forces) const {
  const VecX f = load(forces);
  VecX on_dofs = VecX::Zero(inverse_.dofs());
  for (Index node = 0; node < mesh_.node_count(); ++node)
    if (first_dof(node) >= 0) on_dofs.segment<3>(first_dof(node)) = f.segment<3>(3 * node);
  const VecX solved = inverse_ * on_dofs;
  VecX u = VecX::Zero(f.size());
  for (Index node = 0; node < mesh_.node_count(); ++node)
    if (first_dof(node) >= 0) u.segment<3>(3 * node) = solved.segment<3>(first_dof(node));
  return u;
}

VecX InverseCompliance::displacement(const Eigen::Ref<const MatX>& forces) const {
  const VecX u = nodal_displacement(forces);
  const TetMesh& base = tissue_->mesh();
  VecX result = u.head(3 * base.node_count());
  for (Index node = 0; node < base.node_count(); ++node) {
    const Vec3& x = base.nodes[static_cast<std::size_t>(node)];
    if (mesh_.position(node) == x) continue;  // the node has moved away: interpolate at its former place
    const Index e = mesh_.find(x, locator_->topology().node_tets[static_cast<std::size_t>(node)].front());
    if (e < 0) continue;
    const Vec4 weights = mesh_.element(e).weights(x);
    Vec3 value = Vec3::Zero();
    for (int i = 0; i < 4; ++i)
      value += weights[i] * u.segment<3>(3 * mesh_.element(e).nodes[static_cast<std::size_t>(i)]);
    result.segment<3>(3 * node) = value;
  }
  return result;
}

ContactCompliance::Nodes InverseCompliance::nodes(const Eigen::Ref<const MatX>& forces) const {
  const VecX u = nodal_displacement(forces);
  VecX support = VecX::Zero(u.size());
  for (const AdaptedMesh::Element& element : mesh_.elements()) {
    if (!element.present) continue;
    for (int i = 0; i < 4; ++i) {
      const Index node = element.nodes[static_cast<std::size_t>(i)];
      if (first_dof(node) >= 0) continue;
      for (int j = 0; j < 4; ++j) {
        support.segment<3>(3 * node) += element_block(element.gradients, element.volume, material_of(element), i, j) *
                                        u.segment<3>(3 * element.nodes[static_cast<std::size_t>(j)]);
      }
    }
  }
  return {mesh_.positions(), load(forces), support};
}

Mat3 InverseCompliance::gradient_at_tip(const Eigen::Ref<const MatX>& forces) const {
  const Point& tip = points_of_[kTip];
  if (tip.base_tet < 0) return Mat3::Zero();
  const Index e = move_nodes_ ? mesh_.find(tip.x, tip.base_tet) : -1;
  const auto gradients = e >= 0 ? mesh_.element(e).gradients : barycentric_gradients(tissue_->mesh(), tip.base_tet);
  const auto& corners = e >= 0 ? mesh_.element(e).nodes : tip.node;
  Mat3 gradient = Mat3::Zero();
  for (int i = 0; i < 4; ++i) {
    Point corner;
    corner.node[0] = corners[static_cast<std::size_t>(i)];
    corner.weight[0] = 1.0;
    Vec3 u = Vec3::Zero();
    for (int c = 0; c < points_; ++c) {
      if (forces.col(c).isZero(0.0)) continue;
      u += compliance(corner, points_of_[static_cast<std::size_t>(c)]) * forces.col(c);
    }
    gradient += u * gradients.col(i).transpose();
  }
  return gradient;
}

}  // namespace stylet::paper

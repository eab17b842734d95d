// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/track_compliance.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace stylet {

namespace {
/// Vertices a split may have: two elements that share a face.
constexpr int kObservablesPerPoint = 6;

/// The displacement of a node itself.
Shape single_node(Index node) { return {.count = 1, .node = {node}, .weight = {1.0}}; }
}  // namespace

TrackCompliance::TrackCompliance(std::shared_ptr<const ComplianceStore> store, const Locator& locator, int capacity)
    : store_(std::move(store)), mesh_(locator, capacity), capacity_(capacity) {
  const auto observables = static_cast<std::size_t>(capacity * kObservablesPerPoint + kFirstFree);
  observables_.reserve(observables);
  vertex_of_.reserve(observables);
  splits_.reserve(static_cast<std::size_t>(capacity));
  node_point_.reserve(static_cast<std::size_t>(capacity));
  point_observable_.reserve(static_cast<std::size_t>(capacity) + 1);
  z_.resize(observables * static_cast<std::size_t>(capacity));
  hat_.assign(observables * static_cast<std::size_t>(capacity), 0.0);
  through_.resize(static_cast<std::size_t>(capacity) * static_cast<std::size_t>(capacity));
  changes_.reserve(static_cast<std::size_t>(capacity));
  tip_node_rows_.resize(static_cast<std::size_t>(kMostElementNodes * (capacity + 1)));
  tip_row_ = VecX::Zero(9 * static_cast<Eigen::Index>(capacity));
  A_ = MatX::Zero(3 * (capacity + 1), 3 * (capacity + 1));
  reset();
}

void TrackCompliance::reset() {
  mesh_.reset();
  observables_.assign(static_cast<std::size_t>(kFirstFree), Observable{});
  vertex_of_.assign(static_cast<std::size_t>(kFirstFree), -1);
  splits_.clear();
  node_point_.clear();
  point_observable_.assign(1, 0);
  points_ = 1;
  ++version_;
  changes_.clear();
  tip_ = {};
  tip_element_.reset();
  A_.setZero();
}

bool TrackCompliance::stored(Index base_tet) const {
  const auto nodes = store_->tissue().nodes_of(base_tet);
  return std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return store_->has(node); });
}

Material TrackCompliance::material_of(Index base_tet) const {
  const Tissue& tissue = store_->tissue();
  return tissue.material(tissue.mesh().tet_region[static_cast<std::size_t>(base_tet)]);
}

Mat3 TrackCompliance::base_block(const Observable& a, const Observable& b) const {
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.shape.count); ++i) {
    if (a.shape.weight[i] == 0.0) continue;
    for (std::size_t j = 0; j < static_cast<std::size_t>(b.shape.count); ++j) {
      if (b.shape.weight[j] == 0.0) continue;
      sum += (a.shape.weight[i] * b.shape.weight[j]) * store_->block(a.shape.node[i], b.shape.node[j]);
    }
  }
  return sum;
}

Mat3 TrackCompliance::compliance(int a, int b, int splits) const {
  Mat3 sum = base_block(observables_[static_cast<std::size_t>(a)], observables_[static_cast<std::size_t>(b)]);
  for (int p = 0; p < splits; ++p) {
    const Split& split = splits_[static_cast<std::size_t>(p)];
    if (split.vertices == 0) {  // inside an element z_p = b_p I
      const double product = hat(a, p) * hat(b, p);
      if (product != 0.0) sum += product * split.flexibility;
    } else {
      sum.noalias() += z(a, p) * split.flexibility * z(b, p).transpose();
    }
  }
  return sum;
}

void TrackCompliance::extend(int observable, int splits) {
  Observable& o = observables_[static_cast<std::size_t>(observable)];
  for (int p = o.known; p < splits; ++p) {
    const Split& split = splits_[static_cast<std::size_t>(p)];
    Mat3 value = hat(observable, p) * Mat3::Identity();
    // Σ_j A_{p−1}(x,j) k_jp, the hats in A_{p−1} taken together.
    for (int j = 0; j < split.vertices; ++j) {
      const auto k = static_cast<std::size_t>(j);
      value.noalias() -= base_block(o, observables_[static_cast<std::size_t>(split.vertex[k])]) * split.border[k];
    }
    for (int q = 0; split.vertices > 0 && q < p; ++q)
      value.noalias() -= z(observable, q) * splits_[static_cast<std::size_t>(q)].flexibility * through(q, p);
    z(observable, p) = value;
  }
  o.known = std::max(o.known, splits);
}

int TrackCompliance::new_observable(const Shape& shape, Index vertex) {
  const int number = static_cast<int>(observables_.size());
  observables_.push_back({shape, 0});
  vertex_of_.push_back(vertex);
  for (int p = 0; p < capacity_; ++p) hat(number, p) = 0.0;
  return number;
}

int TrackCompliance::vertex_observable(Index vertex) {
  if (mesh_.is_added(vertex)) {
    const int point = node_point_[static_cast<std::size_t>(mesh_.added(vertex))];
    return point_observable_[static_cast<std::size_t>(point)];
  }
  const auto found = std::find(vertex_of_.begin() + kFirstFree, vertex_of_.end(), vertex);
  if (found != vertex_of_.end()) return static_cast<int>(found - vertex_of_.begin());
  return new_observable(single_node(vertex), vertex);
}

void TrackCompliance::interpolate_hats(int observable, const SplitMesh::Leaf& leaf, const Vec4& leaf_weights) {
  for (int v = 0; v < 4; ++v) {
    const Index vertex = leaf.vertices[static_cast<std::size_t>(v)];
    if (!mesh_.is_added(vertex)) continue;
    const int of_vertex = vertex_observable(vertex);
    for (std::size_t p = 0; p < splits_.size(); ++p) {
      hat(observable, static_cast<int>(p)) += leaf_weights[v] * hat(of_vertex, static_cast<int>(p));
    }
  }
}

void TrackCompliance::add_hat_stiffness(Mat3& stiffness, const SplitMesh::Leaf& leaf, const Vec4& leaf_weights) const {
  // The child that replaces vertex q has volume V l_q and hat gradient g_q / l_q.
  const Material material = material_of(leaf.base_tet);
  const auto g = mesh_.gradients(leaf);
  const double volume = mesh_.volume(leaf);
  for (int q = 0; q < 4; ++q) {
    if (leaf_weights[q] == 0.0) continue;
    const Vec3 gq = g.col(q);
    stiffness += (volume / leaf_weights[q]) * ((material.lambda() + material.mu()) * gq * gq.transpose() +
                                               material.mu() * gq.squaredNorm() * Mat3::Identity());
  }
}

void TrackCompliance::add_border(Split& split, const SplitMesh::Leaf& leaf, int opposite) {
  // Σ over the children of volume × hat gradient = V Σ_{q ≠ o} g_q = −V g_o, so the border is −K_jo of the whole
  // element.
  const Material material = material_of(leaf.base_tet);
  const auto g = mesh_.gradients(leaf);
  const double volume = mesh_.volume(leaf);
  for (int j = 0; j < 4; ++j) {
    const int observable = vertex_observable(leaf.vertices[static_cast<std::size_t>(j)]);
    const Mat3 block = -element_block(g, volume, material, j, opposite);
    const auto end = split.vertex.begin() + split.vertices;
    const auto found = std::find(split.vertex.begin(), end, observable);
    if (found == end) {
      split.vertex[static_cast<std::size_t>(split.vertices)] = observable;
      split.border[static_cast<std::size_t>(split.vertices)] = block;
      ++split.vertices;
    } else {
      split.border[static_cast<std::size_t>(found - split.vertex.begin())] += block;
    }
  }
}

TrackCompliance::Added TrackCompliance::place_inside(const MaterialPoint& at, const Vec3& x) {
  const SplitMesh::Leaf leaf = mesh_.leaf_at(at.tet, x);
  const Vec4 weights = mesh_.weights(leaf, x);
  if (weights.minCoeff() < kSmallestWeight) return {-1, Refusal::geometry};
  Split split;
  Mat3 stiffness = Mat3::Zero();
  add_hat_stiffness(stiffness, leaf, weights);
  split.flexibility = stiffness.inverse();
  const int observable = new_observable(store_->tissue().shape(at.tet, at.weights), -1);
  interpolate_hats(observable, leaf, weights);
  hat(observable, static_cast<int>(splits_.size())) = 1.0;
  mesh_.split_inside(leaf, x);
  splits_.push_back(split);
  node_point_.push_back(points_);
  changes_.push_back({.kind = RemeshEvent::Kind::added_inside,
                      .point = points_,
                      .node = mesh_.locator().mesh().node_count() + static_cast<Index>(splits_.size()) - 1,
                      .dimension = 15,
                      .elements = 4});
  return {finish_point(observable), Refusal::none};
}

TrackCompliance::Added TrackCompliance::place_on_face(const MaterialPoint& at, const Vec3& x, const Vec3& travel) {
  const Locator& locator = mesh_.locator();
  const double nudge = 1e-6 * std::cbrt(std::abs(tet_volume(locator.mesh(), at.tet)));
  const Vec3 ahead = x + nudge * travel.normalized();
  const Vec3 behind = x - nudge * travel.normalized();
  const auto first = locator.find(behind, at.tet);
  const auto second = locator.find(ahead, at.tet);
  if (!first && !second) return {-1, Refusal::geometry};
  // At the outer surface only one element exists; call it the first.
  const Index one_tet = first ? first->tet : second->tet;
  const SplitMesh::Leaf one = mesh_.leaf_at(one_tet, first ? behind : ahead);
  SplitMesh::Leaf two;
  if (first && second) {
    two = mesh_.leaf_at(second->tet, ahead);
    if (!stored(second->tet)) return {-1, Refusal::missing};
  }
  if (!stored(one_tet)) return {-1, Refusal::missing};

  Vec4 weights_one = mesh_.weights(one, x);
  int local_one = 0;
  weights_one.cwiseAbs().minCoeff(&local_one);
  if (std::abs(weights_one[local_one]) > 1e-4) return {-1, Refusal::geometry};  // x is not on a face
  weights_one[local_one] = 0.0;
  for (int q = 0; q < 4; ++q) {
    if (q != local_one && weights_one[q] < kSmallestFaceWeight) return {-1, Refusal::geometry};
  }
  Vec4 weights_two = Vec4::Zero();
  int local_two = -1;
  if (two.base_tet >= 0) {
    weights_two = mesh_.weights(two, x);
    weights_two.cwiseAbs().minCoeff(&local_two);
    weights_two[local_two] = 0.0;
    for (int q = 0; q < 4; ++q) {  // both leaves must have the same three vertices on the face
      if (q == local_two) continue;
      const Index vertex = two.vertices[static_cast<std::size_t>(q)];
      const auto found = std::find(one.vertices.begin(), one.vertices.end(), vertex);
      if (found == one.vertices.end() || found - one.vertices.begin() == local_one) return {-1, Refusal::geometry};
    }
  }

  Split split;
  Mat3 stiffness = Mat3::Zero();
  add_hat_stiffness(stiffness, one, weights_one);
  add_border(split, one, local_one);
  if (two.base_tet >= 0) {
    add_hat_stiffness(stiffness, two, weights_two);
    add_border(split, two, local_two);
  }
  const int p = static_cast<int>(splits_.size());
  Mat3 reduced = stiffness;
  for (int i = 0; i < split.vertices; ++i) extend(split.vertex[static_cast<std::size_t>(i)], p);
  // Σ_ij k_ipᵀ A_{p−1}(i,j) k_jp, again the hats taken together.
  for (int i = 0; i < split.vertices; ++i) {
    const auto a = static_cast<std::size_t>(i);
    Mat3 moved = Mat3::Zero();  // vertex i, by the base compliance
    for (int j = 0; j < split.vertices; ++j) {
      const auto b = static_cast<std::size_t>(j);
      moved.noalias() += base_block(observables_[static_cast<std::size_t>(split.vertex[a])],
                                    observables_[static_cast<std::size_t>(split.vertex[b])]) *
                         split.border[b];
    }
    reduced.noalias() -= split.border[a].transpose() * moved;
  }
  for (int q = 0; q < p; ++q) {
    Mat3& sum = through(q, p);
    sum.setZero();
    for (int j = 0; j < split.vertices; ++j) {
      const auto k = static_cast<std::size_t>(j);
      sum.noalias() += z(split.vertex[k], q).transpose() * split.border[k];
    }
    reduced.noalias() -= sum.transpose() * splits_[static_cast<std::size_t>(q)].flexibility * sum;
  }
  split.flexibility = reduced.inverse();
  split.flexibility = 0.5 * (split.flexibility + split.flexibility.transpose()).eval();

  const Vec4 base_weights = locator.weights(one_tet, x);
  const int observable = new_observable(store_->tissue().shape(one_tet, base_weights), -1);
  interpolate_hats(observable, one, weights_one);
  hat(observable, p) = 1.0;
  mesh_.split_face(one, local_one, two, local_two, x);
  splits_.push_back(split);
  node_point_.push_back(points_);

  const bool inner = two.base_tet >= 0;
  changes_.push_back({.kind = RemeshEvent::Kind::added_on_face,
                      .point = points_,
                      .node = mesh_.locator().mesh().node_count() + p,
                      .dimension = inner ? 18 : 15,
                      .elements = inner ? 6 : 3});

  // The new hat lets the old points move more: A += z s⁻¹ zᵀ.
  for (int c = 0; c < points_; ++c) extend(point_observable_[static_cast<std::size_t>(c)], p + 1);
  if (tip_.tet >= 0) {
    for (int i = 0; i < tip_element_.count(); ++i) know_tip_node(tip_element_.number(i));
  }
  for (int c = 0; c < points_; ++c) {
    const Mat3 left = z(point_observable_[static_cast<std::size_t>(c)], p) * splits_.back().flexibility;
    for (int d = c; d < points_; ++d) {
      const Mat3 more = left * z(point_observable_[static_cast<std::size_t>(d)], p).transpose();
      A_.block<3, 3>(3 * c, 3 * d) += more;
      if (d > c) A_.block<3, 3>(3 * d, 3 * c) += more.transpose();
    }
  }
  return {finish_point(observable), Refusal::none};
}

int TrackCompliance::finish_point(int observable) {
  ++version_;
  extend(observable, static_cast<int>(splits_.size()));
  point_observable_.push_back(observable);
  ++points_;
  write_row(points_ - 1);
  const int splits = static_cast<int>(splits_.size());
  for (int i = 0; i < tip_element_.count(); ++i) {
    const int number = tip_element_.number(i);
    extend(kTipNodes + number, splits);
    tip_node_row(number, points_ - 1) = compliance(kTipNodes + number, observable, splits);
  }
  return points_ - 1;
}

/// A of a node of the tip's element and all points.
void TrackCompliance::know_tip_node(int number) {
  const int splits = static_cast<int>(splits_.size());
  extend(kTipNodes + number, splits);
  for (int c = 1; c < points_; ++c)
    tip_node_row(number, c) = compliance(kTipNodes + number, point_observable_[static_cast<std::size_t>(c)], splits);
}

/// The tip is interpolated, so its row is as well.
void TrackCompliance::write_tip_row() {
  const Shape& shape = observables_[0].shape;
  // The blocks of one node lie one behind the other, those of all points but the tip.
  const Eigen::Index size = 9 * static_cast<Eigen::Index>(points_ - 1);
  auto row = tip_row_.head(size);
  row.setZero();
  for (int i = 0; i < shape.count; ++i) {
    const Mat3& first = tip_node_row(tip_element_.number(i), 1);
    row += shape.weight[static_cast<std::size_t>(i)] * Eigen::Map<const VecX>(first.data(), size);
  }
  A_.block(0, 3, 3, size / 3) = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>(row.data(), 3, size / 3);
  A_.block(3, 0, size / 3, 3) = A_.block(0, 3, 3, size / 3).transpose();
  const Mat3 own = compliance(0, 0, static_cast<int>(splits_.size()));
  A_.topLeftCorner<3, 3>() = 0.5 * (own + own.transpose());  // rounding must not make it unsymmetric
}

void TrackCompliance::write_row(int point) {
  const int splits = static_cast<int>(splits_.size());
  const int observable = point_observable_[static_cast<std::size_t>(point)];
  for (int d = 0; d < points_; ++d) {
    // In this order the store is read along the columns of this point's few nodes.
    const Mat3 block = compliance(point_observable_[static_cast<std::size_t>(d)], observable, splits);
    A_.block<3, 3>(3 * d, 3 * point) = block;
    A_.block<3, 3>(3 * point, 3 * d) = block.transpose();
  }
  // Rounding must not make the diagonal block unsymmetric.
  const Mat3 own = A_.block<3, 3>(3 * point, 3 * point);
  A_.block<3, 3>(3 * point, 3 * point) = 0.5 * (own + own.transpose());
}

TrackCompliance::Added TrackCompliance::add(const MaterialPoint& at, const Vec3& x, Placement placement,
                                            const Vec3& travel) {
  if (points_ > capacity_ || static_cast<int>(splits_.size()) == capacity_) return {-1, Refusal::capacity};
  if (placement == Placement::face) return place_on_face(at, x, travel);
  if (!stored(at.tet)) return {-1, Refusal::missing};
  if (placement == Placement::interior) return place_inside(at, x);
  return {finish_point(new_observable(store_->tissue().shape(at.tet, at.weights), -1)), Refusal::none};
}

bool TrackCompliance::move_tip(const MaterialPoint& at, const Vec3& /*x*/) {
  if (!stored(at.tet)) return false;
  const Shape shape = store_->tissue().shape(at.tet, at.weights);
  if (at.tet != tip_.tet) {
    for (const int number : tip_element_.enter(shape)) {
      observables_[static_cast<std::size_t>(kTipNodes + number)] = {single_node(tip_element_.node(number)), 0};
      know_tip_node(number);
    }
  }
  tip_ = at;
  observables_[0] = {shape, 0};
  extend(0, static_cast<int>(splits_.size()));
  write_tip_row();
  return true;
}

void TrackCompliance::mark_nodes(std::span<unsigned> stamps, unsigned stamp) const {
  for (const Observable& observable : observables_) {
    for (int i = 0; i < observable.shape.count; ++i)
      stamps[static_cast<std::size_t>(observable.shape.node[static_cast<std::size_t>(i)])] = stamp;
  }
}

void TrackCompliance::remove_last_embedded() {
  observables_.pop_back();
  vertex_of_.pop_back();
  point_observable_.pop_back();
  --points_;
  ++version_;
}

VecX TrackCompliance::displacement(const Eigen::Ref<const MatX>& forces) const {
  return mesh_displacement(forces).head(3 * Eigen::Index{mesh_.locator().mesh().node_count()});
}

VecX TrackCompliance::mesh_displacement(const Eigen::Ref<const MatX>& forces) const {
  return store_->tissue().solve(base_load(forces));
}

TrackCompliance::Nodes TrackCompliance::nodes(const Eigen::Ref<const MatX>& forces) const {
  const Tissue& tissue = store_->tissue();
  const VecX load = base_load(forces);
  std::vector<Vec3> positions;
  positions.reserve(static_cast<std::size_t>(tissue.displacement_nodes()));
  for (Index node = 0; node < tissue.displacement_nodes(); ++node) positions.push_back(tissue.node_position(node));
  return {std::move(positions), load, tissue.support_forces(tissue.solve(load))};
}

Mat3 TrackCompliance::gradient_at_tip(const Eigen::Ref<const MatX>& forces) const {
  if (tip_.tet < 0) return Mat3::Zero();
  const int splits = static_cast<int>(splits_.size());
  const ShapeGradients shape = store_->tissue().shape_gradients(tip_.tet, tip_.weights);
  Mat3 gradient = Mat3::Zero();
  for (int i = 0; i < shape.count; ++i) {
    const int number = tip_element_.number(i);
    Vec3 u = compliance(kTipNodes + number, 0, splits) * forces.col(kTip);
    for (int c = 1; c < points_; ++c) u.noalias() += tip_node_row(number, c) * forces.col(c);
    gradient.noalias() += u * shape.gradient.col(i).transpose();
  }
  return gradient;
}

VecX TrackCompliance::base_load(const Eigen::Ref<const MatX>& forces) const {
  MatX load = MatX::Zero(3, static_cast<Eigen::Index>(observables_.size()));
  for (int c = 0; c < points_; ++c) load.col(point_observable_[static_cast<std::size_t>(c)]) += forces.col(c);
  // Condense the hats, last first: a hat's amplitude w loads the vertices of its border by −k_jp w.
  for (int p = static_cast<int>(splits_.size()) - 1; p >= 0; --p) {
    const Split& split = splits_[static_cast<std::size_t>(p)];
    if (split.vertices == 0) continue;
    Vec3 work = Vec3::Zero();
    for (std::size_t o = 0; o < observables_.size(); ++o) {
      if (load.col(static_cast<Eigen::Index>(o)).isZero(0.0)) continue;
      work.noalias() += z(static_cast<int>(o), p).transpose() * load.col(static_cast<Eigen::Index>(o));
    }
    const Vec3 amplitude = split.flexibility * work;
    for (int j = 0; j < split.vertices; ++j) {
      load.col(split.vertex[static_cast<std::size_t>(j)]).noalias() -=
          split.border[static_cast<std::size_t>(j)] * amplitude;
    }
  }
  VecX result = VecX::Zero(3 * store_->tissue().displacement_nodes());
  for (std::size_t o = 0; o < observables_.size(); ++o) {
    const Shape& shape = observables_[o].shape;
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
      result.segment<3>(3 * shape.node[i]) += shape.weight[i] * load.col(static_cast<Eigen::Index>(o));
    }
  }
  return result;
}

}  // namespace stylet

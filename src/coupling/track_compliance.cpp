// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/track_compliance.hpp"

#include "core/dense_kernels.hpp"
#include "coupling/hat_stiffness.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace stylet {

namespace {
/// Vertices of two elements that share a face.
constexpr int kBorderVertices = 5;
/// A point, and those vertices.
constexpr int kObservablesPerPoint = 1 + kBorderVertices;

/// Weights that are rounding errors.
constexpr double kNoWeight = 1e-12;

/// Rounding must not make a block of the diagonal unsymmetric.
Mat3 symmetric_part(const Mat3& block) { return 0.5 * (block + block.transpose()); }

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
  passed_on_.resize(static_cast<std::size_t>(capacity) * static_cast<std::size_t>(capacity));
  nodes_.reserve(observables * kMostElementNodes);
  field_.resize(observables * kMostElementNodes);
  amplitude_.resize(static_cast<std::size_t>(capacity) + 1);
  borders_.reserve(static_cast<std::size_t>(capacity * kBorderVertices));
  constexpr int most_loads = kBorderVertices * kMostElementNodes;
  load_node_.reserve(static_cast<std::size_t>(capacity * most_loads));
  load_.reserve(static_cast<std::size_t>(capacity * most_loads));
  blocks_.resize(static_cast<std::size_t>(most_loads));
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
  nodes_.clear();
  borders_.clear();
  load_node_.clear();
  load_.clear();
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

Mat3 TrackCompliance::base_moved(Index node, const Split& split) {
  const auto nodes = split.loads.of(load_node_);
  for (std::size_t k = 0; k < nodes.size(); ++k) blocks_[k] = store_->block(node, nodes[k]);
  return dense::sum_of_products(std::span(blocks_).first(nodes.size()), split.loads.of(load_));
}

Mat3 TrackCompliance::at_nodes(const Observable& o) const {
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(o.shape.count); ++i)
    sum += o.shape.weight[i] * field_[static_cast<std::size_t>(o.number[i])];
  return sum;
}

Mat3 TrackCompliance::compliance(int a, int b) const {
  Mat3 sum = base_block(observables_[static_cast<std::size_t>(a)], observables_[static_cast<std::size_t>(b)]);
  for (int p = 0; p < static_cast<int>(splits_.size()); ++p) {
    if (!splits_[static_cast<std::size_t>(p)].inside()) {
      sum.noalias() += z(a, p) * amplitude(b, p);
    } else if (const double product = hat(a, p) * hat(b, p); product != 0.0) {
      sum += product * splits_[static_cast<std::size_t>(p)].flexibility;
    }
  }
  return sum;
}

Mat3 TrackCompliance::amplitude(int observable, int split) const {
  const Split& of = splits_[static_cast<std::size_t>(split)];
  if (of.inside()) return hat(observable, split) * of.flexibility;  // inside an element z_p = b_p I
  return of.flexibility * z(observable, split).transpose();
}

void TrackCompliance::load_nodes_by(const Split& split) {
  for (std::size_t m = 0; m < nodes_.size(); ++m) field_[m] = base_moved(nodes_[m], split);
}

void TrackCompliance::load_nodes_by(int observable) {
  const Shape& shape = observables_[static_cast<std::size_t>(observable)].shape;
  for (std::size_t m = 0; m < nodes_.size(); ++m) {
    field_[m].setZero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
      if (shape.weight[i] != 0.0) field_[m] += shape.weight[i] * store_->block(nodes_[m], shape.node[i]);
    }
  }
}

void TrackCompliance::load_hats_by(int observable) {
  for (std::size_t p = 0; p < splits_.size(); ++p) amplitude_[p] = amplitude(observable, static_cast<int>(p));
}

Mat3 TrackCompliance::moved_by_hats(int observable) const {
  // With nodes inside elements only z_p = b_p I, and few b_p are not zero.
  if (!borders_.empty())
    return dense::sum_of_products({&z(observable, 0), splits_.size()}, std::span(amplitude_).first(splits_.size()));
  Mat3 sum = Mat3::Zero();
  for (std::size_t p = 0; p < splits_.size(); ++p) {
    const double b = hat(observable, static_cast<int>(p));
    if (b != 0.0) sum += b * amplitude_[p];
  }
  return sum;
}

void TrackCompliance::set_z(int observable, int split, const Mat3& base) {
  Mat3 value = hat(observable, split) * Mat3::Identity() - base;
  if (!splits_[static_cast<std::size_t>(split)].inside()) {
    const auto earlier = static_cast<std::size_t>(split);
    value -= dense::sum_of_products({&z(observable, 0), earlier}, {&passed_on(0, split), earlier});
  }
  z(observable, split) = value;
  observables_[static_cast<std::size_t>(observable)].known = split + 1;
}

void TrackCompliance::extend(int observable) {
  const Observable& o = observables_[static_cast<std::size_t>(observable)];
  for (int p = o.known; p < static_cast<int>(splits_.size()); ++p) {
    const Split& split = splits_[static_cast<std::size_t>(p)];
    Mat3 base = Mat3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(o.shape.count); ++i) {
      if (o.shape.weight[i] != 0.0 && !split.inside()) base += o.shape.weight[i] * base_moved(o.shape.node[i], split);
    }
    set_z(observable, p, base);
  }
}

void TrackCompliance::extend_all() {
  for (int c = 1; c < points_; ++c) extend(point_observable_[static_cast<std::size_t>(c)]);
  for (int i = 0; i < tip_element_.count(); ++i) extend(kTipNodes + tip_element_.number(i));
}

int TrackCompliance::new_observable(const Shape& shape, Index vertex) {
  const int number = static_cast<int>(observables_.size());
  Observable o{.shape = shape, .nodes_before = nodes_.size()};
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
    // The nodes that came last are those of elements near by.
    const auto found = std::find(nodes_.rbegin(), nodes_.rend(), shape.node[i]);
    o.number[i] = static_cast<int>(nodes_.rend() - found) - 1;
    if (found != nodes_.rend()) continue;
    o.number[i] = static_cast<int>(nodes_.size());
    nodes_.push_back(shape.node[i]);
  }
  observables_.push_back(o);
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
  const int number = new_observable(single_node(vertex), vertex);
  for (int i = 0; i < tip_element_.count(); ++i) {
    const int of_tip = tip_element_.number(i);
    if (tip_element_.node(of_tip) == vertex) copy_z(kTipNodes + of_tip, number);
  }
  return number;
}

void TrackCompliance::copy_z(int from, int to) {
  const int known = observables_[static_cast<std::size_t>(from)].known;
  std::copy_n(&z(from, 0), known, &z(to, 0));
  observables_[static_cast<std::size_t>(to)].known = known;
}

void TrackCompliance::interpolate_hats(int observable, const SplitMesh::Part& part) {
  for (int v = 0; v < 4; ++v) {
    const Index vertex = part.leaf.vertices[static_cast<std::size_t>(v)];
    if (!mesh_.is_added(vertex)) continue;
    const int of_vertex = vertex_observable(vertex);
    for (std::size_t p = 0; p < splits_.size(); ++p) {
      hat(observable, static_cast<int>(p)) += part.weights[v] * hat(of_vertex, static_cast<int>(p));
    }
  }
}

void TrackCompliance::add_border(Split& split, const SplitMesh::Leaf& leaf, std::span<const Mat3, 4> k) {
  for (std::size_t j = 0; j < 4; ++j) {
    const int observable = vertex_observable(leaf.vertices[j]);
    const auto borders = split.border.of(borders_);
    const auto found =
        std::find_if(borders.begin(), borders.end(), [&](const Border& border) { return border.vertex == observable; });
    if (found != borders.end()) {
      found->k += k[j];
      continue;
    }
    borders_.push_back({observable, k[j]});
    ++split.border.count;
  }
}

void TrackCompliance::gather_loads(Split& split) {
  for (const Border& border : split.border.of(borders_)) {
    const Shape& shape = observables_[static_cast<std::size_t>(border.vertex)].shape;
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
      if (shape.weight[i] == 0.0) continue;
      const Mat3 load = shape.weight[i] * border.k;
      const auto nodes = split.loads.of(load_node_);
      const auto found = std::find(nodes.begin(), nodes.end(), shape.node[i]);
      if (found != nodes.end()) {
        split.loads.of(load_)[static_cast<std::size_t>(found - nodes.begin())] += load;
        continue;
      }
      load_node_.push_back(shape.node[i]);
      load_.push_back(load);
      ++split.loads.count;
    }
  }
}

int TrackCompliance::add_inside(const SplitMesh::Place& place, const Shape& shape) {
  const SplitMesh::Part& part = place.part[0];
  const int p = static_cast<int>(splits_.size());
  const int observable = new_observable(shape, -1);
  interpolate_hats(observable, part);
  hat(observable, p) = 1.0;
  const Mat3 stiffness =
      hat_stiffness(mesh_.gradients(part.leaf), mesh_.volume(part.leaf), material_of(part.leaf.base_tet), part.weights);
  splits_.push_back({.border = {}, .loads = {}, .flexibility = stiffness.inverse()});
  extend_all();
  split_elements(place);
  return finish_point(observable);
}

int TrackCompliance::add_on_face(const SplitMesh::Place& place, const Shape& shape) {
  const int p = static_cast<int>(splits_.size());
  add_bordered_split(place);
  const int observable = new_observable(shape, -1);
  interpolate_from_face(observable, place.part[0]);
  split_elements(place);
  loosen_points(p);
  return finish_point(observable);
}

/// The node is the next point's.
void TrackCompliance::split_elements(const SplitMesh::Place& place) {
  const Index node = mesh_.split(place);
  node_point_.push_back(points_);
  const auto kind = place.inside() ? RemeshEvent::Kind::added_inside : RemeshEvent::Kind::added_on_face;
  const int vertices = 4 + place.count;  // of the elements together, the new one among them
  const int children = place.inside() ? 4 : 3;
  changes_.push_back(
      {.kind = kind, .point = points_, .node = node, .dimension = 3 * vertices, .elements = place.count * children});
}

/// A split with a border, and z of the border's vertices.
void TrackCompliance::add_bordered_split(const SplitMesh::Place& place) {
  Split split{.border = {borders_.size()}, .loads = {load_.size()}};
  Mat3 stiffness = Mat3::Zero();
  for (const SplitMesh::Part& part : place.parts()) {
    const auto gradients = mesh_.gradients(part.leaf);
    const double volume = mesh_.volume(part.leaf);
    const Material material = material_of(part.leaf.base_tet);
    stiffness += hat_stiffness(gradients, volume, material, part.weights);
    add_border(split, part.leaf, hat_border(gradients, volume, material, part.opposite));
  }
  gather_loads(split);
  const int p = static_cast<int>(splits_.size());
  const auto borders = split.border.of(borders_);
  for (const Border& border : borders) extend(border.vertex);
  extend_all();
  for (int q = 0; q < p; ++q) {
    Mat3 sum = Mat3::Zero();
    for (const Border& border : borders) sum.noalias() += z(border.vertex, q).transpose() * border.k;
    passed_on(q, p).noalias() = splits_[static_cast<std::size_t>(q)].flexibility * sum;
  }
  splits_.push_back(split);
  load_nodes_by(split);
  // The new hat vanishes at the vertices, so z_p = −Σ_j A_{p−1}(i,j) k_jp there, and s_p = k_pp + Σ_i k_ipᵀ z_p(i).
  for (const Border& border : borders) {
    set_z(border.vertex, p, at_nodes(observables_[static_cast<std::size_t>(border.vertex)]));
    stiffness.noalias() += border.k.transpose() * z(border.vertex, p);
  }
  splits_.back().flexibility = symmetric_part(stiffness.inverse());
}

/// Hats and z of the node of the last split, which is on a face.
void TrackCompliance::interpolate_from_face(int observable, const SplitMesh::Part& part) {
  const int p = static_cast<int>(splits_.size()) - 1;
  interpolate_hats(observable, part);
  hat(observable, p) = 1.0;
  // What was linear in the element that is split is interpolated.
  for (int q = 0; q <= p; ++q) {
    Mat3& value = z(observable, q);
    value = (q == p ? 1.0 : 0.0) * Mat3::Identity();
    for (int v = 0; v < 4; ++v) {
      if (v == part.opposite) continue;
      value += part.weights[v] * z(vertex_observable(part.leaf.vertices[static_cast<std::size_t>(v)]), q);
    }
  }
  observables_[static_cast<std::size_t>(observable)].known = p + 1;
}

/// The hat of split p, for whose loads field_ is, lets the points move more: A += z s⁻¹ zᵀ.
void TrackCompliance::loosen_points(int p) {
  for (int c = 1; c < points_; ++c) {
    const int of = point_observable_[static_cast<std::size_t>(c)];
    const Observable& o = observables_[static_cast<std::size_t>(of)];
    if (o.known == p) set_z(of, p, at_nodes(o));  // no vertex of this border
    amplitude_[static_cast<std::size_t>(c)] = amplitude(of, p);
  }
  for (int c = 1; c < points_; ++c) {
    const Mat3& left = z(point_observable_[static_cast<std::size_t>(c)], p);
    A_.block<3, 3>(3 * c, 3 * c) += symmetric_part(left * amplitude_[static_cast<std::size_t>(c)]);
    for (int d = c + 1; d < points_; ++d) {
      const Mat3 more = left * amplitude_[static_cast<std::size_t>(d)];
      A_.block<3, 3>(3 * c, 3 * d) += more;
      A_.block<3, 3>(3 * d, 3 * c) += more.transpose();
    }
  }
  for (int i = 0; i < tip_element_.count(); ++i) {
    const int number = tip_element_.number(i);
    extend(kTipNodes + number);
    for (int c = 1; c < points_; ++c)
      tip_node_row(number, c).noalias() += z(kTipNodes + number, p) * amplitude_[static_cast<std::size_t>(c)];
  }
  interpolate_tip(p);
  A_.topLeftCorner<3, 3>() += symmetric_part(z(0, p) * amplitude(0, p));
}

int TrackCompliance::finish_point(int observable) {
  ++version_;
  extend(observable);
  point_observable_.push_back(observable);
  ++points_;
  const Observable& o = observables_[static_cast<std::size_t>(observable)];
  load_hats_by(observable);
  for (int i = 0; i < tip_element_.count(); ++i) {
    const int node = kTipNodes + tip_element_.number(i);
    tip_node_row(tip_element_.number(i), points_ - 1) =
        base_block(observables_[static_cast<std::size_t>(node)], o) + moved_by_hats(node);
  }
  if (const auto weights = tip_element_.weights(o.shape)) {
    interpolate_row(observable, *weights);
  } else {
    load_nodes_by(observable);
    write_row(points_ - 1, [&](int /*point*/, int of) { return at_nodes(observables_[static_cast<std::size_t>(of)]); });
  }
  write_tip_row();
  return points_ - 1;
}

/// A of a point in the tip's element, whose nodes' rows are known: nothing of the store is needed.
/// @param weights of the tip's nodes, by their numbers
void TrackCompliance::interpolate_row(int observable, const TipElement::Weights& weights) {
  combine_tip_rows(weights);
  // The nodes have their share of hats from splits with a border. What is left is the point's own.
  for (std::size_t p = 0; p < splits_.size(); ++p) {
    if (splits_[p].inside()) continue;
    Mat3 interpolated = Mat3::Zero();
    for (int i = 0; i < tip_element_.count(); ++i) {
      const int number = tip_element_.number(i);
      interpolated += weights[static_cast<std::size_t>(number)] * z(kTipNodes + number, static_cast<int>(p));
    }
    const Mat3 own = z(observable, static_cast<int>(p)) - interpolated;
    amplitude_[p].noalias() = splits_[p].flexibility * own.transpose();
  }
  write_row(points_ - 1, [&](int point, int /*of*/) -> Mat3 {
    return Eigen::Map<const Mat3>(tip_row_.data() + 9 * static_cast<Eigen::Index>(point - 1)).transpose();
  });
}

/// A of a point and all points but the tip: of each what is given of it and its number, and what the hats add.
template <class Rest>
void TrackCompliance::write_row(int point, const Rest& rest) {
  for (int d = 1; d < points_; ++d) {
    const int of = point_observable_[static_cast<std::size_t>(d)];
    const Mat3 block = rest(d, of) + moved_by_hats(of);
    A_.block<3, 3>(3 * d, 3 * point) = block;
    A_.block<3, 3>(3 * point, 3 * d) = block.transpose();
  }
  const Mat3 own = A_.block<3, 3>(3 * point, 3 * point);
  A_.block<3, 3>(3 * point, 3 * point) = symmetric_part(own);
}

/// A of a node of the tip's element and all points.
void TrackCompliance::know_tip_node(int number) {
  const auto vertex = std::find(vertex_of_.begin() + kFirstFree, vertex_of_.end(), tip_element_.node(number));
  if (vertex != vertex_of_.end()) copy_z(static_cast<int>(vertex - vertex_of_.begin()), kTipNodes + number);
  extend(kTipNodes + number);
  load_nodes_by(kTipNodes + number);
  load_hats_by(kTipNodes + number);
  for (int c = 1; c < points_; ++c) {
    const int of = point_observable_[static_cast<std::size_t>(c)];
    tip_node_row(number, c) = (at_nodes(observables_[static_cast<std::size_t>(of)]) + moved_by_hats(of)).transpose();
  }
}

/// The tip is interpolated, so z_p is as well, from one split on.
void TrackCompliance::interpolate_tip(int from) {
  const Observable& tip = observables_[0];
  for (int p = from; p < static_cast<int>(splits_.size()); ++p) {
    if (splits_[static_cast<std::size_t>(p)].inside()) continue;  // the tip has no hat
    Mat3& value = z(0, p);
    value.setZero();
    for (int i = 0; i < tip.shape.count; ++i)
      value += tip.shape.weight[static_cast<std::size_t>(i)] * z(kTipNodes + tip_element_.number(i), p);
  }
}

/// Σ (weight of the node) × (its row), into tip_row_.
void TrackCompliance::combine_tip_rows(const TipElement::Weights& weights) {
  // The blocks of one node lie one behind the other, those of all points but the tip.
  const Eigen::Index size = 9 * static_cast<Eigen::Index>(points_ - 1);
  auto row = tip_row_.head(size);
  row.setZero();
  for (int i = 0; i < tip_element_.count(); ++i) {
    const int number = tip_element_.number(i);
    row += weights[static_cast<std::size_t>(number)] * Eigen::Map<const VecX>(tip_node_row(number, 1).data(), size);
  }
}

/// And its row of A but for its own block.
void TrackCompliance::write_tip_row() {
  const auto weights = tip_element_.weights(observables_[0].shape);
  if (!weights) return;  // nowhere yet
  combine_tip_rows(*weights);
  const Eigen::Index columns = 3 * static_cast<Eigen::Index>(points_ - 1);
  A_.block(0, 3, 3, columns) = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>(tip_row_.data(), 3, columns);
  A_.block(3, 0, columns, 3) = A_.block(0, 3, 3, columns).transpose();
}

TrackCompliance::Added TrackCompliance::add(const MaterialPoint& at, const Vec3& x, Placement placement,
                                            const Vec3& travel) {
  if (points_ > capacity_ || static_cast<int>(splits_.size()) == capacity_) return {-1, Refusal::capacity};
  if (placement == Placement::face) {
    const auto place = mesh_.place_on_face(at.tet, x, travel, kSmallestFaceWeight);
    if (!place) return {-1, Refusal::geometry};
    const auto parts = place->parts();
    if (!std::all_of(parts.begin(), parts.end(), [&](const auto& part) { return stored(part.leaf.base_tet); }))
      return {-1, Refusal::missing};
    return {add_on_face(*place, shape_on_face(parts.front().leaf.base_tet, x)), Refusal::none};
  }
  std::optional<SplitMesh::Place> inside;
  if (placement == Placement::interior) {
    inside = mesh_.place_inside(at.tet, x, kSmallestWeight);
    if (!inside) return {-1, Refusal::geometry};
  }
  if (!stored(at.tet)) return {-1, Refusal::missing};
  const Shape shape = store_->tissue().shape(at.tet, at.weights);
  return {inside ? add_inside(*inside, shape) : finish_point(new_observable(shape, -1)), Refusal::none};
}

/// On a face of the base mesh the node opposite has no part, and the element beyond, where the tip is, has all others.
Shape TrackCompliance::shape_on_face(Index base_tet, const Vec3& x) const {
  Vec4 weights = mesh_.locator().weights(base_tet, x);
  weights = (weights.array().abs() < kNoWeight).select(0.0, weights);
  weights /= weights.sum();
  return store_->tissue().shape(base_tet, weights);
}

bool TrackCompliance::move_tip(const MaterialPoint& at, const Vec3& /*x*/) {
  if (!stored(at.tet)) return false;
  const Shape shape = store_->tissue().shape(at.tet, at.weights);
  if (at.tet != tip_.tet) {
    for (const int number : tip_element_.enter(shape)) {
      observables_[static_cast<std::size_t>(kTipNodes + number)] = {.shape = single_node(tip_element_.node(number))};
      know_tip_node(number);
    }
  }
  tip_ = at;
  observables_[0] = {.shape = shape};
  interpolate_tip(0);
  write_tip_row();
  A_.topLeftCorner<3, 3>() = symmetric_part(compliance(0, 0));
  return true;
}

void TrackCompliance::mark_nodes(std::span<unsigned> stamps, unsigned stamp) const {
  for (const Observable& observable : observables_) {
    for (int i = 0; i < observable.shape.count; ++i)
      stamps[static_cast<std::size_t>(observable.shape.node[static_cast<std::size_t>(i)])] = stamp;
  }
}

void TrackCompliance::remove_last_embedded() {
  nodes_.resize(observables_.back().nodes_before);
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
  const ShapeGradients shape = store_->tissue().shape_gradients(tip_.tet, tip_.weights);
  Mat3 gradient = Mat3::Zero();
  for (int i = 0; i < shape.count; ++i) {
    const int number = tip_element_.number(i);
    Vec3 u = compliance(kTipNodes + number, 0) * forces.col(kTip);
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
    if (split.inside()) continue;
    Vec3 work = Vec3::Zero();
    for (std::size_t o = 0; o < observables_.size(); ++o) {
      if (load.col(static_cast<Eigen::Index>(o)).isZero(0.0)) continue;
      work.noalias() += z(static_cast<int>(o), p).transpose() * load.col(static_cast<Eigen::Index>(o));
    }
    const Vec3 amplitude = split.flexibility * work;
    for (const Border& border : split.border.of(borders_)) load.col(border.vertex).noalias() -= border.k * amplitude;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/track_compliance.hpp"

#include "coupling/hat_stiffness.hpp"
#include "coupling/track/added_hats.hpp"
#include "coupling/track/tip_element_rows.hpp"

#include <algorithm>

namespace stylet {

namespace {
constexpr int kTipPlace = TrackObservables::kTip;
constexpr int kTipNodes = TrackObservables::kTipNodes;

/// Largest number of observables beside the tip: each point is one, and each added node may add the vertices of its
/// border.
int most_observables(int capacity, int most_nodes) { return capacity + most_nodes * SplitBorders::kMostVertices; }

/// Weights below this are rounding errors of 0. Raised, nodes off a face count as on it.
constexpr double kNoWeight = 1e-12;

/// Removes the asymmetry that rounding gives to a diagonal block.
Mat3 symmetric_part(const Mat3& block) { return 0.5 * (block + block.transpose()); }

/// The shape of a node itself.
Shape single_node(Index node) { return {.count = 1, .node = {node}, .weight = {1.0}}; }
}  // namespace

TrackCompliance::TrackCompliance(std::shared_ptr<const ComplianceStore> store, const Locator& locator, int capacity,
                                 int most_nodes)
    : store_(std::move(store)),
      mesh_(locator, capacity),
      capacity_(capacity),
      most_nodes_(most_nodes < 0 ? capacity : most_nodes),
      observables_(std::make_unique<TrackObservables>(store_, most_observables(capacity, most_nodes_),
                                                      SplitBorders::kMostLoads)),
      borders_(std::make_unique<SplitBorders>(most_nodes_)),
      hats_(std::make_unique<AddedHats>(most_observables(capacity, most_nodes_) + TrackObservables::kFirstFree,
                                        most_nodes_)),
      tip_rows_(std::make_unique<TipElementRows>(capacity)) {
  tip_neighbours_.reserve(capacity + 1);
  point_observable_.reserve(static_cast<std::size_t>(capacity) + 1);
  node_point_.reserve(static_cast<std::size_t>(capacity));
  by_points_.resize(static_cast<std::size_t>(capacity) + 1);
  changes_.reserve(static_cast<std::size_t>(capacity));
  A_ = MatX::Zero(3 * (capacity + 1), 3 * (capacity + 1));
  reset();
}

TrackCompliance::~TrackCompliance() = default;

void TrackCompliance::reset() {
  mesh_.reset();
  observables_->reset();
  borders_->reset();
  hats_->reset();
  tip_rows_->reset();
  tip_neighbours_.reset();
  point_observable_.assign(1, kTipPlace);
  node_point_.clear();
  changes_.clear();
  points_ = 1;
  ++version_;
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

/// The compliance between two observables [mm/N], base mesh and hats together.
Mat3 TrackCompliance::compliance(int a, int b) const { return hats_->compliance(a, b, observables_->compliance(a, b)); }

int TrackCompliance::new_observable(const Shape& shape, Index vertex) {
  const int number = observables_->add(shape, vertex);
  hats_->clear(number);
  return number;
}

/// Number of a vertex of the split mesh among the observables; adds the vertex if it is not among them.
int TrackCompliance::vertex_observable(Index vertex) {
  if (mesh_.is_added(vertex)) return observable_of(node_point_[static_cast<std::size_t>(mesh_.added(vertex))]);
  const int found = observables_->find(vertex);
  if (found >= 0) return found;
  const int number = new_observable(single_node(vertex), vertex);
  const TipElement& element = tip_rows_->element();
  for (int i = 0; i < element.count(); ++i) {
    if (element.node(element.number(i)) == vertex) hats_->copy_z(kTipNodes + element.number(i), number);
  }
  return number;
}

/// Computes z of an observable for all splits for which it is not known yet.
void TrackCompliance::extend(int observable) {
  for (int p = hats_->known(observable); p < hats_->count(); ++p)
    hats_->extend_z(observable,
                    hats_->inside(p) ? Mat3::Zero() : observables_->moved_by(borders_->loads(p), observable));
}

/// Computes z of all points and of the nodes of the tip's element for all splits.
void TrackCompliance::extend_all() {
  for (int c = 1; c < points_; ++c) extend(observable_of(c));
  const TipElement& element = tip_rows_->element();
  for (int i = 0; i < element.count(); ++i) extend(kTipNodes + element.number(i));
}

/// Computes the hats at an observable from those at its leaf's vertices, because the hats of earlier nodes are linear
/// in the leaf.
void TrackCompliance::interpolate_hats(int observable, const SplitMesh::Part& part) {
  for (int v = 0; v < 4; ++v) {
    const Index vertex = part.leaf.vertices[static_cast<std::size_t>(v)];
    if (mesh_.is_added(vertex)) hats_->add_hats(observable, vertex_observable(vertex), part.weights[v]);
  }
}

int TrackCompliance::add_inside(const SplitMesh::Place& place, const Shape& shape) {
  const SplitMesh::Part& part = place.part[0];
  const int observable = new_observable(shape, -1);
  interpolate_hats(observable, part);
  hats_->set_node(observable, hats_->count());
  borders_->begin();
  hats_->add_inside(hat_stiffness(mesh_.gradients(part.leaf), mesh_.volume(part.leaf), material_of(part.leaf.base_tet),
                                  part.weights));
  extend_all();
  split_elements(place);
  return finish_point(observable);
}

int TrackCompliance::add_on_face(const SplitMesh::Place& place, const Shape& shape) {
  const int p = hats_->count();
  add_bordered_split(place);
  const int observable = new_observable(shape, -1);
  interpolate_from_face(observable, place.part[0]);
  split_elements(place);
  loosen_points(p);
  return finish_point(observable);
}

/// Splits the elements at a new node, which the next point will use.
void TrackCompliance::split_elements(const SplitMesh::Place& place) {
  const Index node = mesh_.split(place);
  node_point_.push_back(points_);
  const auto kind = place.inside() ? RemeshEvent::Kind::added_inside : RemeshEvent::Kind::added_on_face;
  const int vertices = 4 + place.count;  // of the split elements together, the new vertex included
  const int children = place.inside() ? 4 : 3;
  changes_.push_back(
      {.kind = kind, .point = points_, .node = node, .dimension = 3 * vertices, .elements = place.count * children});
}

/// Adds the split by a node on a face, and computes z of its border's vertices. The observables are then loaded by the
/// split.
void TrackCompliance::add_bordered_split(const SplitMesh::Place& place) {
  borders_->begin();
  Mat3 stiffness = Mat3::Zero();
  for (const SplitMesh::Part& part : place.parts()) {
    const auto gradients = mesh_.gradients(part.leaf);
    const double volume = mesh_.volume(part.leaf);
    const Material material = material_of(part.leaf.base_tet);
    stiffness += hat_stiffness(gradients, volume, material, part.weights);
    const auto k = hat_border(gradients, volume, material, part.opposite);
    for (std::size_t j = 0; j < 4; ++j) borders_->add(vertex_observable(part.leaf.vertices[j]), k[j]);
  }
  const int p = hats_->count();
  const auto border = borders_->border(p);
  for (const auto& [vertex, k] : border) borders_->add_loads(observables_->shape(vertex), k);
  for (const auto& [vertex, k] : border) extend(vertex);
  extend_all();
  hats_->add_bordered(border);
  observables_->load(borders_->loads(p));
  for (const auto& [vertex, k] : border) hats_->extend_z(vertex, observables_->at(vertex));
  hats_->complete(border, stiffness);
}

/// Computes the hats and z of the node of the last split, which is on a face, by interpolation from the face's
/// vertices, because earlier fields are linear in the element that is split.
void TrackCompliance::interpolate_from_face(int observable, const SplitMesh::Part& part) {
  const int p = hats_->count() - 1;
  interpolate_hats(observable, part);
  hats_->set_node(observable, p);
  std::array<int, 3> corner{};  // of the face
  std::array<double, 3> weight{};
  std::size_t corners = 0;
  for (int v = 0; v < 4; ++v) {
    if (v == part.opposite) continue;
    weight[corners] = part.weights[v];
    corner[corners++] = vertex_observable(part.leaf.vertices[static_cast<std::size_t>(v)]);
  }
  for (int q = 0; q <= p; ++q) hats_->interpolate_z(observable, q, q == p ? 1.0 : 0.0, corner, weight);
}

/// Adds the hat of split p, A += z s⁻¹ zᵀ. The observables must be loaded by the split.
void TrackCompliance::loosen_points(int p) {
  for (int c = 1; c < points_; ++c) {
    const int of = observable_of(c);
    if (hats_->known(of) == p) hats_->extend_z(of, observables_->at(of));  // not a vertex of this border
    by_points_[static_cast<std::size_t>(c)] = hats_->amplitude(of, p);
  }
  for (int c = 1; c < points_; ++c) {
    const Mat3& left = hats_->z(observable_of(c), p);
    A_.block<3, 3>(3 * c, 3 * c) += symmetric_part(left * by_points_[static_cast<std::size_t>(c)]);
    for (int d = c + 1; d < points_; ++d) {
      const Mat3 more = left * by_points_[static_cast<std::size_t>(d)];
      A_.block<3, 3>(3 * c, 3 * d) += more;
      A_.block<3, 3>(3 * d, 3 * c) += more.transpose();
    }
  }
  const TipElement& element = tip_rows_->element();
  for (int i = 0; i < element.count(); ++i) {
    const int number = element.number(i);
    extend(kTipNodes + number);
    for (int c = 1; c < points_; ++c)
      tip_rows_->row(number, c).noalias() += hats_->z(kTipNodes + number, p) * by_points_[static_cast<std::size_t>(c)];
  }
  interpolate_tip(p);
  A_.topLeftCorner<3, 3>() += symmetric_part(hats_->z(kTipPlace, p) * hats_->amplitude(kTipPlace, p));
}

/// Makes an observable the next point and writes its rows. In the tip's element the row of the point is interpolated
/// from the rows of the element's nodes, so that the store is not read.
/// @return number of the point
int TrackCompliance::finish_point(int observable) {
  ++version_;
  extend(observable);
  point_observable_.push_back(observable);
  ++points_;
  hats_->load(observable);
  const auto tip_node = tip_nodes();
  const auto nodes = std::span(tip_node).first(static_cast<std::size_t>(tip_rows_->element().count()));
  for (const int node : nodes)
    tip_rows_->row(node - kTipNodes, points_ - 1) = observables_->compliance(node, observable) + hats_->moved(node);
  if (const auto weights = tip_rows_->element().weights(observables_->shape(observable))) {
    std::array<double, kMostElementNodes> weight{};
    for (std::size_t i = 0; i < nodes.size(); ++i)
      weight[i] = (*weights)[static_cast<std::size_t>(nodes[i] - kTipNodes)];
    // The rows of the nodes contain the hats of splits with a border; the rest belongs to the point only.
    hats_->load_beyond(observable, nodes, std::span(weight).first(nodes.size()));
    const auto row = tip_rows_->combine(*weights, points_ - 1);
    write_row(points_ - 1, [&](int point, int /*of*/) -> Mat3 {
      return row.middleCols<3>(3 * static_cast<Eigen::Index>(point - 1)).transpose();
    });
  } else {
    observables_->load(observable);
    write_row(points_ - 1, [&](int /*point*/, int of) { return observables_->at(of); });
  }
  write_tip_row();
  if (!tip_neighbours_.are_all()) write_tip(points_ - 1);
  return points_ - 1;
}

/// Writes A between a point and all points but the tip: the displacement by the hats, and the rest.
/// @param rest function: (point, its observable) → the part of A without the hats [mm/N]
template <class Rest>
void TrackCompliance::write_row(int point, const Rest& rest) {
  for (int d = 1; d < points_; ++d) {
    const int of = observable_of(d);
    const Mat3 block = rest(d, of) + hats_->moved(of);
    A_.block<3, 3>(3 * d, 3 * point) = block;
    A_.block<3, 3>(3 * point, 3 * d) = block.transpose();
  }
  const Mat3 own = A_.block<3, 3>(3 * point, 3 * point);
  A_.block<3, 3>(3 * point, 3 * point) = symmetric_part(own);
}

/// The nodes of the tip's element among the observables, in the element's order; only the first element().count() are
/// valid.
std::array<int, kMostElementNodes> TrackCompliance::tip_nodes() const {
  const TipElement& element = tip_rows_->element();
  std::array<int, kMostElementNodes> nodes{};
  for (int i = 0; i < element.count(); ++i) nodes[static_cast<std::size_t>(i)] = kTipNodes + element.number(i);
  return nodes;
}

/// Computes z of a node that is new to the tip's element, and A between it and all points.
void TrackCompliance::know_tip_node(int number) {
  const int observable = kTipNodes + number;
  const Index node = tip_rows_->element().node(number);
  observables_->set(observable, single_node(node));
  hats_->clear(observable);
  if (const int vertex = observables_->find(node); vertex >= 0) hats_->copy_z(vertex, observable);
  extend(observable);
  observables_->load(observable);
  hats_->load(observable);
  for (int c = 1; c < points_; ++c) {
    const int of = observable_of(c);
    tip_rows_->row(number, c) = (observables_->at(of) + hats_->moved(of)).transpose();
  }
}

/// Computes z of the tip for split `from` and all later ones, by interpolation from the nodes of its element.
void TrackCompliance::interpolate_tip(int from) {
  const Shape& tip = observables_->shape(kTipPlace);
  const auto count = static_cast<std::size_t>(tip.count);
  const auto nodes = tip_nodes();
  for (int p = from; p < hats_->count(); ++p) {
    if (hats_->inside(p)) continue;  // the tip has no hat
    hats_->interpolate_z(kTipPlace, p, 0.0, std::span(nodes).first(count), std::span(tip.weight).first(count));
  }
}

/// Writes A between the tip and all other points.
void TrackCompliance::write_tip_row() {
  const auto weights = tip_rows_->element().weights(observables_->shape(kTipPlace));
  if (!weights) return;  // the tip has no place yet
  if (!tip_neighbours_.are_all()) {
    tip_neighbours_.for_each(points_, [&](int point) { write_tip(point); });
    return;
  }
  const auto row = tip_rows_->combine(*weights, points_ - 1);
  A_.block(0, 3, 3, row.cols()) = row;
  A_.block(3, 0, row.cols(), 3) = A_.block(0, 3, 3, row.cols()).transpose();
}

/// The same for one point.
void TrackCompliance::write_tip(int point) {
  const auto weights = tip_rows_->element().weights(observables_->shape(kTipPlace));
  if (!weights) return;
  const Mat3 block = tip_rows_->combine_one(*weights, point);
  A_.block<3, 3>(0, 3 * point) = block;
  A_.block<3, 3>(3 * point, 0) = block.transpose();
}

TrackCompliance::Added TrackCompliance::add(const MaterialPoint& at, const Vec3& x, Placement placement,
                                            const Vec3& travel) {
  const bool is_node = placement != Placement::embedded;
  if (points_ > capacity_ || (is_node && hats_->count() == most_nodes_)) return {-1, Refusal::capacity};
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

/// Shape of a place on a face of the base mesh: without the opposite node, so that the element beyond, where the tip
/// is, has all its nodes.
Shape TrackCompliance::shape_on_face(Index base_tet, const Vec3& x) const {
  Vec4 weights = mesh_.locator().weights(base_tet, x);
  weights = (weights.array().abs() < kNoWeight).select(0.0, weights);
  weights /= weights.sum();
  return store_->tissue().shape(base_tet, weights);
}

bool TrackCompliance::move_tip(const MaterialPoint& at, const Vec3& /*x*/) {
  if (!stored(at.tet)) return false;
  const Shape shape = store_->tissue().shape(at.tet, at.weights);
  for (const int number : tip_rows_->move(at, shape)) know_tip_node(number);
  observables_->set(kTipPlace, shape);
  interpolate_tip(0);
  write_tip_row();
  A_.topLeftCorner<3, 3>() = symmetric_part(compliance(kTipPlace, kTipPlace));
  return true;
}

void TrackCompliance::mark_nodes(std::span<unsigned> stamps, unsigned stamp) const {
  observables_->mark_nodes(stamps, stamp);
}

void TrackCompliance::remove_last_embedded() {
  observables_->remove_last();
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
  VecX load = base_load(forces);
  const VecX u = store_->tissue().solve(load);
  return nodes_under(std::move(load), u);
}

TrackCompliance::Moment TrackCompliance::moment(const Eigen::Ref<const MatX>& present,
                                                const Eigen::Ref<const MatX>& lasting) const {
  VecX load = base_load(present);
  MatX both(load.size(), lasting.cols() > 0 ? 2 : 1);
  both.col(0) = load;
  if (both.cols() > 1) both.col(1) = base_load(lasting);
  both = store_->tissue().solve(both);
  return {both.rowwise().sum().head(3 * Eigen::Index{mesh_.locator().mesh().node_count()}),
          nodes_under(std::move(load), both.col(0))};
}

/// @param load [N] (3n) @param u [mm] (3n) its solution
TrackCompliance::Nodes TrackCompliance::nodes_under(VecX load, const VecX& u) const {
  const Tissue& tissue = store_->tissue();
  std::vector<Vec3> positions;
  positions.reserve(static_cast<std::size_t>(tissue.displacement_nodes()));
  for (Index node = 0; node < tissue.displacement_nodes(); ++node) positions.push_back(tissue.node_position(node));
  return {std::move(positions), std::move(load), tissue.support_forces(u)};
}

Mat3 TrackCompliance::gradient_at_tip(const Eigen::Ref<const MatX>& forces) const {
  const MaterialPoint& tip = tip_rows_->at();
  if (tip.tet < 0) return Mat3::Zero();
  const ShapeGradients shape = store_->tissue().shape_gradients(tip.tet, tip.weights);
  Mat3 gradient = Mat3::Zero();
  for (int i = 0; i < shape.count; ++i) {
    const int number = tip_rows_->element().number(i);
    Vec3 u = compliance(kTipNodes + number, kTipPlace) * forces.col(kTip);
    for (int c = 1; c < points_; ++c) u.noalias() += tip_rows_->row(number, c) * forces.col(c);
    gradient.noalias() += u * shape.gradient.col(i).transpose();
  }
  return gradient;
}

VecX TrackCompliance::base_load(const Eigen::Ref<const MatX>& forces) const {
  MatX load = MatX::Zero(3, observables_->count());
  for (int c = 0; c < points_; ++c) load.col(observable_of(c)) += forces.col(c);
  // Condense the hats, last first: a hat of amplitude w loads the vertices of its border by −k_jp w.
  for (int p = hats_->count() - 1; p >= 0; --p) {
    if (hats_->inside(p)) continue;
    Vec3 work = Vec3::Zero();
    for (int o = 0; o < observables_->count(); ++o) {
      if (!load.col(o).isZero(0.0)) work.noalias() += hats_->z(o, p).transpose() * load.col(o);
    }
    const Vec3 amplitude = hats_->flexibility(p) * work;
    for (const auto& [vertex, k] : borders_->border(p)) load.col(vertex).noalias() -= k * amplitude;
  }
  VecX result = VecX::Zero(3 * store_->tissue().displacement_nodes());
  for (int o = 0; o < observables_->count(); ++o) {
    const Shape& shape = observables_->shape(o);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      result.segment<3>(3 * shape.node[i]) += shape.weight[i] * load.col(o);
  }
  return result;
}

}  // namespace stylet

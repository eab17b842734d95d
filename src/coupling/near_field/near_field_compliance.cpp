// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/near_field_compliance.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// Beyond so many edges the mesh represents the field as it is: what is left is its error of interpolation, of relative
/// size (edge / distance)² / 8.
constexpr double kReach = 5.0;

Medium scaled(Medium medium, double young_MPa) {
  medium.mu *= young_MPa;
  return medium;
}

}  // namespace

NearFieldCompliance::NearFieldCompliance(std::unique_ptr<ContactCompliance> far, std::shared_ptr<const Tissue> tissue,
                                         std::shared_ptr<const MeshKernel> kernel, const NeedleKernel& needle,
                                         int capacity)
    : far_(std::move(far)),
      tissue_(std::move(tissue)),
      kernel_(std::move(kernel)),
      needle_(needle),
      capacity_(capacity + 1) {
  places_.reserve(static_cast<std::size_t>(capacity) + 1);
  const std::size_t entries = tip_node_entry(kMostElementNodes, 0, 0);
  tip_node_g_.assign(entries, Mat3::Zero());
  tip_node_known_.assign(entries, 0);
  A_ = MatX::Zero(3 * (capacity + 1), 3 * (capacity + 1));
  reset();
}

void NearFieldCompliance::reset() {
  far_->reset();
  press_N_ = 0.0;
  places_.assign(1, Place{});
  points_ = 1;
  ++version_;
  tip_tet_ = -1;
  tip_element_.reset();
  A_.setZero();
}

bool NearFieldCompliance::available(Index base_tet) const {
  const auto nodes = tissue_->nodes_of(base_tet);
  return far_->available(base_tet) &&
         std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return kernel_->has(node); });
}

NearFieldCompliance::Place NearFieldCompliance::place_at(const MaterialPoint& at, const Vec3& x) const {
  const Tissue& tissue = *tissue_;
  const int region = tissue.mesh().tet_region[static_cast<std::size_t>(at.tet)];
  Place place;
  place.shape = tissue.shape(at.tet, at.weights);
  place.piece.centre = x;
  place.medium = kernel_->medium_of(region);
  place.young_MPa = tissue.material(region).young_MPa;
  const NearSurface& any = kernel_->skin(tissue.mesh().tets[static_cast<std::size_t>(at.tet)][0]);
  const bool has_skin = std::isfinite(any.depth);
  place.skin = {0.0, Vec3::Zero(), 0.0};
  place.moves = 0.0;
  const auto& corners = tissue.mesh().tets[static_cast<std::size_t>(at.tet)];
  for (int i = 0; i < 4; ++i) {
    const Index corner = corners[static_cast<std::size_t>(i)];
    const double weight = at.weights[i];
    place.edge += weight * kernel_->edge(corner);
    if (!tissue.is_fixed(corner)) place.moves += weight;
    if (!has_skin) continue;
    const NearSurface& there = kernel_->skin(corner);
    place.skin.depth += weight * there.depth;
    place.skin.inwards += weight * there.inwards;
    place.skin.share += weight * there.share;
  }
  place.moves = std::clamp(place.moves, 0.0, 1.0);
  place.skin.inwards.normalize();
  place.skin.depth = std::max(0.0, place.skin.depth);
  if (!has_skin) place.skin = {};
  return place;
}

Mat3 NearFieldCompliance::of_mesh(const Shape& at, const Shape& on, int medium) const {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < at.count; ++i) {
    for (int j = 0; j < on.count; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      const double weight = at.weight[a] * on.weight[b];
      if (weight != 0.0) sum += weight * (*kernel_)(at.node[a], on.node[b], medium);
    }
  }
  return sum;
}

/// The same between tip and another point: what the element's nodes have to do with the point stays while the tip goes
/// through the element.
Mat3 NearFieldCompliance::of_mesh_at_tip(int point, int medium) {
  const Shape& tip = places_[kTip].shape;
  const Shape& on = places_[static_cast<std::size_t>(point)].shape;
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < tip.count; ++i) {
    const int number = tip_element_.number(i);
    const std::size_t entry = tip_node_entry(number, point, medium);
    if (tip_node_known_[entry] == 0) {
      const Shape node{.count = 1, .node = {tip_element_.node(number)}, .weight = {1.0}};
      tip_node_g_[entry] = of_mesh(node, on, medium);
      tip_node_known_[entry] = 1;
    }
    sum += tip.weight[static_cast<std::size_t>(i)] * tip_node_g_[entry];
  }
  return sum;
}

void NearFieldCompliance::forget_tip_node(int number, int first_point, int last_point) {
  const auto at = [&](int point) {
    return tip_node_known_.begin() + static_cast<std::ptrdiff_t>(tip_node_entry(number, point, 0));
  };
  std::fill(at(first_point), at(last_point), char{0});
}

bool NearFieldCompliance::neighbours(const Shape& at, const Shape& on) const {
  for (int i = 0; i < at.count; ++i) {
    for (int j = 0; j < on.count; ++j) {
      if (kernel_->neighbours(at.node[static_cast<std::size_t>(i)], on.node[static_cast<std::size_t>(j)])) return true;
    }
  }
  return false;
}

/// What the needle's kernel and the mesh's differ by. @param g g(at, on) in a medium
template <class OfMesh>
Mat3 NearFieldCompliance::correction(const Place& at, const Place& on, const OfMesh& g) const {
  const double edge = 0.5 * (at.edge + on.edge);
  const double distance2 = (at.piece.centre - on.piece.centre).squaredNorm();
  if (distance2 > kReach * kReach * edge * edge) return Mat3::Zero();
  if (distance2 < edge * edge && !neighbours(at.shape, on.shape)) return Mat3::Zero();  // across a gap of air
  const double share = at.moves * on.moves;
  if (share == 0.0) return Mat3::Zero();
  const double epsilon = std::sqrt(at.epsilon * on.epsilon);
  const auto for_unit = [&](int medium) -> Mat3 {  // both are inversely proportional to Young's modulus
    return needle_kernel(at.piece, at.skin, on.piece, on.skin, epsilon, kernel_->medium(medium)) - g(medium);
  };
  const double of_at = 0.5 * share / at.young_MPa;
  const double of_on = 0.5 * share / on.young_MPa;
  if (at.medium == on.medium) return (of_at + of_on) * for_unit(at.medium);
  return of_at * for_unit(at.medium) + of_on * for_unit(on.medium);
}

template <class OfMesh>
void NearFieldCompliance::write_block(int point, int other, const OfMesh& g) {
  const Place& at = places_[static_cast<std::size_t>(point)];
  const Place& on = places_[static_cast<std::size_t>(other)];
  Mat3 block = (*far_)(point, other) + correction(at, on, g);
  if (point == other) block = 0.5 * (block + block.transpose()).eval();
  A_.block<3, 3>(3 * point, 3 * other) = block;
  A_.block<3, 3>(3 * other, 3 * point) = block.transpose();
}

ContactCompliance::Added NearFieldCompliance::add(const MaterialPoint& at, const Vec3& x, Placement /*placement*/,
                                                  const Vec3& travel) {
  if (!available(at.tet)) return {-1, Refusal::missing};
  const Added added = far_->add(at, x, Placement::embedded);
  if (added.point < 0) return added;
  Place place = place_at(at, x);
  if (travel.squaredNorm() > 0.0) {
    place.piece.direction = travel.normalized();
    place.piece.length = needle_.segment_mm;
  }
  place.epsilon = needle_.shaft_epsilon();
  places_.push_back(place);
  ++points_;
  ++version_;
  for (int number = 0; number < kMostElementNodes; ++number) forget_tip_node(number, added.point, added.point + 1);
  write_block(added.point, kTip, [&](int medium) -> Mat3 { return of_mesh_at_tip(added.point, medium).transpose(); });
  for (int d = 1; d < points_; ++d)
    write_block(added.point, d,
                [&](int medium) { return of_mesh(place.shape, places_[static_cast<std::size_t>(d)].shape, medium); });
  return added;
}

bool NearFieldCompliance::move_tip(const MaterialPoint& at, const Vec3& x) {
  if (!available(at.tet)) return false;
  far_->move_tip(at, x);
  Place& tip = places_[kTip];
  tip = place_at(at, x);
  tip.epsilon = needle_.tip_epsilon(tip.skin.depth, kernel_->medium(tip.medium).poisson);
  if (at.tet != tip_tet_) {
    for (const int number : tip_element_.enter(tip.shape)) forget_tip_node(number, 0, capacity_);
    tip_tet_ = at.tet;
  }
  write_block(kTip, kTip, [&](int medium) { return of_mesh(tip.shape, tip.shape, medium); });
  for (int d = 1; d < points_; ++d) write_block(kTip, d, [&](int medium) { return of_mesh_at_tip(d, medium); });
  if (tip.skin.inwards.dot(entry_) > 0.0)  // not the far surface, from inside
    A_.topLeftCorner<3, 3>() +=
        tip.moves * needle_.dent(tip.skin, press_N_, scaled(kernel_->medium(tip.medium), tip.young_MPa));
  return true;
}

void NearFieldCompliance::mark_nodes(std::span<unsigned> stamps, unsigned stamp) const {
  far_->mark_nodes(stamps, stamp);
  for (const Place& place : places_) {
    for (int i = 0; i < place.shape.count; ++i)
      stamps[static_cast<std::size_t>(place.shape.node[static_cast<std::size_t>(i)])] = stamp;
  }
}

void NearFieldCompliance::remove_last_embedded() {
  far_->remove_last_embedded();
  places_.pop_back();
  --points_;
  ++version_;
}

Mat3 NearFieldCompliance::gradient_at_tip(const Eigen::Ref<const MatX>& forces) const {
  return far_->gradient_at_tip(forces);
}

/// What forces on the points move a passive place by, beyond what the mesh has there.
Vec3 NearFieldCompliance::near_field(Place here, const Eigen::Ref<const MatX>& forces) const {
  const bool nowhere = here.young_MPa == 0.0;  // a node, between media: the contact's will do
  Vec3 sum = Vec3::Zero();
  for (int d = 0; d < points_; ++d) {
    if (forces.col(d).isZero(0.0)) continue;
    const Place& on = places_[static_cast<std::size_t>(d)];
    here.epsilon = on.epsilon;  // being passive, it has no radius of its own
    if (nowhere) {
      here.medium = on.medium;
      here.young_MPa = on.young_MPa;
    }
    const auto g = [&](int medium) { return of_mesh(here.shape, on.shape, medium); };
    sum += correction(here, on, g) * forces.col(d);
  }
  return sum;
}

VecX NearFieldCompliance::displacement(const Eigen::Ref<const MatX>& forces) const {
  VecX u = far_->displacement(forces);
  for (Index node = 0; node < tissue_->mesh().node_count(); ++node) {
    if (tissue_->is_fixed(node) || !kernel_->has(node)) continue;
    Place here;
    here.shape.count = 1;
    here.shape.node[0] = node;
    here.shape.weight[0] = 1.0;
    here.piece.centre = tissue_->node_position(node);
    here.skin = kernel_->skin(node);
    here.edge = kernel_->edge(node);
    u.segment<3>(3 * Eigen::Index{node}) += near_field(here, forces);
  }
  return u;
}

VecX NearFieldCompliance::mesh_displacement(const Eigen::Ref<const MatX>& forces) const {
  return far_->mesh_displacement(forces);
}

ContactCompliance::Nodes NearFieldCompliance::nodes(const Eigen::Ref<const MatX>& forces) const {
  return far_->nodes(forces);
}

}  // namespace stylet

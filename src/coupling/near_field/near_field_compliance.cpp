// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/near_field_compliance.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

Medium scaled(Medium medium, double young_MPa) {
  medium.mu *= young_MPa;
  return medium;
}

/// [mm] The wide part of the compliance is updated when the tip has moved this far. This is small beside its radius of
/// 10 mm, so the wide part hardly changes over it.
constexpr double kWideReach_mm = 0.5;

/// [mm] Elements up to this size represent forces that are spread over 10 mm.
constexpr double kFine_mm = 12.0;
/// [mm] Elements from this size on do not, and K⁻¹ minus the mesh's own kernel is used there. In between, the change is
/// gradual.
constexpr double kCoarse_mm = 15.0;

void write_symmetric(MatX& matrix, int point, int other, Mat3 block) {
  if (point == other) block = 0.5 * (block + block.transpose()).eval();
  matrix.block<3, 3>(3 * point, 3 * other) = block;
  matrix.block<3, 3>(3 * other, 3 * point) = block.transpose();
}

}  // namespace

NearFieldCompliance::NearFieldCompliance(std::unique_ptr<ContactCompliance> far, std::shared_ptr<const Tissue> tissue,
                                         std::shared_ptr<const MeshKernel> kernel, const NeedleKernel& needle,
                                         int capacity, std::vector<double> stiffening_MPa, bool creeps,
                                         std::shared_ptr<const SpreadCompliance> spread)
    : far_(std::move(far)),
      ground_{std::move(tissue), std::move(kernel), std::move(spread), -1},
      needle_(needle),
      region_stiffening_MPa_(std::move(stiffening_MPa)),
      capacity_(capacity + 1) {
  tip_neighbours_.reserve(capacity + 1);
  places_.reserve(static_cast<std::size_t>(capacity) + 1);
  softness_.reserve(places_.capacity());
  const std::size_t entries = tip_node_entry(kMostElementNodes, 0, 0);
  tip_node_g_.assign(entries, Mat3::Zero());
  tip_node_known_.assign(entries, 0);
  A_ = MatX::Zero(3 * (capacity + 1), 3 * (capacity + 1));
  needle_scale_ = MatX::Zero(3 * (capacity + 1), 3);
  if (creeps || std::any_of(region_stiffening_MPa_.begin(), region_stiffening_MPa_.end(),
                            [](double stiffening) { return stiffening > 0.0; }))
    wide_ = A_;
  if (ground_.spread) spread_under_tip_ = MatX::Zero(ground_.spread->matrix().rows(), 3);
  reset();
}

void NearFieldCompliance::reset() {
  far_->reset();
  press_N_ = 0.0;
  places_.assign(1, NearPlace{});
  softness_.assign(1, 1.0);
  points_ = 1;
  ++version_;
  wide_at_.reset();
  ground_.way = -1;
  tip_tet_ = -1;
  tip_element_.reset();
  tip_neighbours_.reset();
  A_.setZero();
  needle_scale_.setZero();
  wide_.setZero();
  stiffening_MPa_ = 0.0;
}

void NearFieldCompliance::write_needle_scale() {
  const Eigen::Index rows = 3 * Eigen::Index{points_};
  needle_scale_.topRows(rows) = A_.topLeftCorner(rows, 3) - wide_.topLeftCorner(rows, 3);
}

/// @param edge_mm size of the elements at x
SpreadCompliance::Place NearFieldCompliance::spread_place(const Vec3& x, double edge_mm) {
  if (!ground_.spread) return {};
  if (ground_.way < 0) ground_.way = ground_.spread->way_near(x);
  SpreadCompliance::Place place = ground_.spread->place(x, ground_.way);
  const double fine = std::clamp((kCoarse_mm - edge_mm) / (kCoarse_mm - kFine_mm), 0.0, 1.0);
  place.known *= fine * fine * (3.0 - 2.0 * fine);
  return place;
}

bool NearFieldCompliance::available(Index base_tet) const {
  const auto nodes = ground_.tissue->nodes_of(base_tet);
  return far_->available(base_tet) &&
         std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return ground_.kernel->has(node); });
}

/// g between the tip and another point, interpolated from g at the nodes of the tip's element, which is cached as long
/// as the tip stays in the element.
Mat3 NearFieldCompliance::of_mesh_at_tip(int point, int medium) {
  const Shape& tip = places_[kTip].shape;
  const Shape& on = places_[static_cast<std::size_t>(point)].shape;
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < tip.count; ++i) {
    const int number = tip_element_.number(i);
    const std::size_t entry = tip_node_entry(number, point, medium);
    if (tip_node_known_[entry] == 0) {
      const Shape node{.count = 1, .node = {tip_element_.node(number)}, .weight = {1.0}};
      tip_node_g_[entry] = mesh_kernel_between(*ground_.kernel, node, on, medium);
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

Mat3 NearFieldCompliance::spread_between(int point, int other) const {
  const SpreadCompliance::Place& at = places_[static_cast<std::size_t>(point)].spread;
  const SpreadCompliance::Place& on = places_[static_cast<std::size_t>(other)].spread;
  if (point == kTip) return SpreadCompliance::at(on, spread_under_tip_).transpose();
  return (*ground_.spread)(at, on);
}

template <class OfMesh>
void NearFieldCompliance::write_block(int point, int other, const OfMesh& g) {
  const NearPlace& at = places_[static_cast<std::size_t>(point)];
  const NearPlace& on = places_[static_cast<std::size_t>(other)];
  const double share = spread_share(at, on);
  Mat3 block = Mat3::Zero();
  if (share < 1.0) block += (1.0 - share) * ((*far_)(point, other) + near_correction(*ground_.kernel, at, on, g));
  if (share > 0.0) block += share * (spread_between(point, other) + narrow_part(*ground_.kernel, at, on));
  write_symmetric(A_, point, other, block);
}

template <class OfMesh>
void NearFieldCompliance::write_wide_block(int point, int other, const OfMesh& g) {
  const NearPlace& at = places_[static_cast<std::size_t>(point)];
  const NearPlace& on = places_[static_cast<std::size_t>(other)];
  const double share = spread_share(at, on);
  Mat3 block = Mat3::Zero();
  if (share < 1.0) {
    // Without this factor, a remainder of the mesh's own near field would exceed the wide field at a border between
    // organs.
    const double soft =
        std::sqrt(softness_[static_cast<std::size_t>(point)] * softness_[static_cast<std::size_t>(other)]);
    block += (1.0 - share) * ((*far_)(point, other) + soft * wide_correction(*ground_.kernel, at, on, g));
  }
  if (share > 0.0) block += share * spread_between(point, other);
  write_symmetric(wide_, point, other, block);
}

void NearFieldCompliance::write_wide_of_tip() {
  const NearPlace& tip = places_[kTip];
  const Mat3 far = (*far_)(kTip, kTip);
  softness_.front() = softness_in_mesh(*ground_.kernel, tip, far, tip.mesh_kernel);
  const double share = spread_share(tip, tip);
  Mat3 own = Mat3::Zero();
  if (share < 1.0)
    own += (1.0 - share) * (far + softness_.front() * tip_wide_correction(*ground_.kernel, tip, tip.mesh_kernel));
  if (share > 0.0) own += share * spread_between(kTip, kTip);
  write_symmetric(wide_, kTip, kTip, own);
  tip_neighbours_.for_each(
      points_, [&](int d) { write_wide_block(kTip, d, [&](int medium) { return of_mesh_at_tip(d, medium); }); });
  wide_at_ = tip.piece.centre;
}

/// Writes what belongs to a point and the tip at its present place.
void NearFieldCompliance::write_tip(int point) {
  if (tip_tet_ < 0) return;
  const auto g = [&](int medium) { return of_mesh_at_tip(point, medium); };
  write_block(kTip, point, g);
  if (!knows_wide()) return;
  write_wide_block(kTip, point, g);
  if (stiffens())
    needle_scale_.middleRows<3>(3 * point) = A_.block<3, 3>(3 * point, 0) - wide_.block<3, 3>(3 * point, 0);
}

ContactCompliance::Added NearFieldCompliance::add(const MaterialPoint& at, const Vec3& x, Placement /*placement*/,
                                                  const Vec3& travel) {
  if (!available(at.tet)) return {-1, Refusal::missing};
  const Added added = far_->add(at, x, Placement::embedded);
  if (added.point < 0) return added;
  NearPlace place = near_place(*ground_.tissue, *ground_.kernel, at, x);
  if (travel.squaredNorm() > 0.0) {
    place.piece.direction = travel.normalized();
    place.piece.length = needle_.segment_mm;
  }
  place.epsilon = needle_.shaft_epsilon();
  const double poisson = ground_.kernel->medium(place.medium).poisson;
  place.share = least_share(place.borders, place.epsilon, poisson);
  place.wide_share = least_share(place.borders, NeedleKernel::kScale_mm, poisson);
  place.spread = spread_place(x, place.edge);
  places_.push_back(place);
  softness_.push_back(
      knows_wide() ? softness_in_mesh(*ground_.kernel, place, (*far_)(added.point, added.point), place.mesh_kernel)
                   : 1.0);
  ++points_;
  ++version_;
  for (int number = 0; number < kMostElementNodes; ++number) forget_tip_node(number, added.point, added.point + 1);
  for (int d = 0; d < points_; ++d) {
    const auto g = [&](int medium) -> Mat3 {
      if (d == kTip) return of_mesh_at_tip(added.point, medium).transpose();
      return mesh_kernel_between(*ground_.kernel, place.shape, places_[static_cast<std::size_t>(d)].shape, medium);
    };
    write_block(added.point, d, g);
    if (knows_wide()) write_wide_block(added.point, d, g);
  }
  if (stiffens()) write_needle_scale();
  return added;
}

bool NearFieldCompliance::move_tip(const MaterialPoint& at, const Vec3& x) {
  if (!available(at.tet)) return false;
  far_->move_tip(at, x);
  NearPlace& tip = places_[kTip];
  tip = near_place(*ground_.tissue, *ground_.kernel, at, x);
  take_tip_radii(needle_, *ground_.kernel, tip);
  tip.spread = spread_place(x, tip.edge);
  if (tip.spread.known > 0.0) ground_.spread->press(tip.spread, spread_under_tip_);
  if (at.tet != tip_tet_) {
    for (const int number : tip_element_.enter(tip.shape)) forget_tip_node(number, 0, capacity_);
    tip_tet_ = at.tet;
  }
  const double share = spread_share(tip, tip);
  Mat3 own = Mat3::Zero();
  if (share < 1.0) own += (1.0 - share) * ((*far_)(kTip, kTip) + tip_correction(*ground_.kernel, tip, tip.mesh_kernel));
  if (share > 0.0) own += share * (spread_between(kTip, kTip) + tip_narrow_part(*ground_.kernel, tip));
  write_symmetric(A_, kTip, kTip, own);
  tip_neighbours_.for_each(points_,
                           [&](int d) { write_block(kTip, d, [&](int medium) { return of_mesh_at_tip(d, medium); }); });
  if (knows_wide() && (!wide_at_ || (x - *wide_at_).squaredNorm() > kWideReach_mm * kWideReach_mm)) write_wide_of_tip();
  stiffening_MPa_ = 0.0;
  if (!region_stiffening_MPa_.empty())
    stiffening_MPa_ =
        stiffening_of(tip, [&](int region) { return region_stiffening_MPa_[static_cast<std::size_t>(region)]; });
  if (stiffens()) write_needle_scale();
  if (tip.skin.inwards.dot(entry_) > 0.0) {  // this excludes the far surface, seen from inside
    const Mat3 more =
        tip.moves *
        needle_.dent(tip.skin, press_N_, scaled(ground_.kernel->medium(tip.medium), tip.young_MPa), stiffening_MPa_);
    A_.topLeftCorner<3, 3>() += more;
    if (stiffens()) needle_scale_.topRows<3>() += more;
  }
  return true;
}

void NearFieldCompliance::mark_nodes(std::span<unsigned> stamps, unsigned stamp) const {
  far_->mark_nodes(stamps, stamp);
  for (const NearPlace& place : places_) {
    for (int i = 0; i < place.shape.count; ++i)
      stamps[static_cast<std::size_t>(place.shape.node[static_cast<std::size_t>(i)])] = stamp;
  }
}

void NearFieldCompliance::remove_last_embedded() {
  far_->remove_last_embedded();
  places_.pop_back();
  softness_.pop_back();
  --points_;
  ++version_;
}

Mat3 NearFieldCompliance::gradient_at_tip(const Eigen::Ref<const MatX>& forces) const {
  return far_->gradient_at_tip(forces);
}

/// Corrects the displacement of the mesh's nodes under forces on the points, at the nodes that the kernel has.
/// @param correction function: displacement of a node's place per force on a point, from g between the two [mm/N]
template <class Correction>
void NearFieldCompliance::add_corrections(const Eigen::Ref<const MatX>& forces, const Correction& correction,
                                          VecX& u) const {
  for (Index node = 0; node < ground_.tissue->mesh().node_count(); ++node) {
    if (ground_.tissue->is_fixed(node) || !ground_.kernel->has(node)) continue;
    const Shape own{.count = 1, .node = {node}, .weight = {1.0}};
    const NearPlace here = passive_place(*ground_.tissue, *ground_.kernel, own, ground_.tissue->node_position(node));
    Vec3 sum = Vec3::Zero();
    for (int d = 0; d < points_; ++d) {
      if (forces.col(d).isZero(0.0)) continue;
      const NearPlace& on = places_[static_cast<std::size_t>(d)];
      const auto g = [&](int medium) { return mesh_kernel_between(*ground_.kernel, here.shape, on.shape, medium); };
      const NearPlace at = acted_on_by(here, on);
      sum += correction(at, d, g) * forces.col(d);
    }
    u.segment<3>(3 * Eigen::Index{node}) += sum;
  }
}

/// Adds the near field of forces on the points to the displacement of the mesh's nodes.
void NearFieldCompliance::add_near(const Eigen::Ref<const MatX>& forces, VecX& u) const {
  add_corrections(
      forces,
      [&](const NearPlace& at, int point, const auto& g) {
        return near_correction(*ground_.kernel, at, places_[static_cast<std::size_t>(point)], g);
      },
      u);
  if (!stiffens()) return;
  const Vec3 press = forces.col(kTip);
  const Vec3 spared = press - tip_dent().under(press).linear;
  for (Index node = 0; node < ground_.tissue->mesh().node_count(); ++node) {
    if (ground_.tissue->is_fixed(node) || !ground_.kernel->has(node)) continue;
    const Shape own{.count = 1, .node = {node}, .weight = {1.0}};
    const NearPlace here = passive_place(*ground_.tissue, *ground_.kernel, own, ground_.tissue->node_position(node));
    const NearPlace& tip = places_[kTip];
    const NearPlace at = acted_on_by(here, tip);
    const auto g = [&](int medium) { return mesh_kernel_between(*ground_.kernel, here.shape, tip.shape, medium); };
    u.segment<3>(3 * Eigen::Index{node}) -= (near_correction(*ground_.kernel, at, tip, g) -
                                             softness_.front() * wide_correction(*ground_.kernel, at, tip, g)) *
                                            spared;
  }
}

/// The same for the wide part of the near field.
void NearFieldCompliance::add_wide(const Eigen::Ref<const MatX>& forces, VecX& u) const {
  if (!knows_wide()) {
    add_near(forces, u);
    return;
  }
  add_corrections(
      forces,
      [&](const NearPlace& at, int point, const auto& g) -> Mat3 {
        const auto p = static_cast<std::size_t>(point);
        return softness_[p] * wide_correction(*ground_.kernel, at, places_[p], g);
      },
      u);
}

VecX NearFieldCompliance::displacement(const Eigen::Ref<const MatX>& forces) const {
  VecX u = far_->displacement(forces);
  add_near(forces, u);
  return u;
}

VecX NearFieldCompliance::wide_displacement(const Eigen::Ref<const MatX>& forces) const {
  VecX u = far_->displacement(forces);
  add_wide(forces, u);
  return u;
}

ContactCompliance::Moment NearFieldCompliance::moment(const Eigen::Ref<const MatX>& present,
                                                      const Eigen::Ref<const MatX>& lasting) const {
  Moment moment = far_->moment(present, lasting);
  add_near(present, moment.displacement);
  if (lasting.cols() > 0) add_wide(lasting, moment.displacement);
  return moment;
}

VecX NearFieldCompliance::mesh_displacement(const Eigen::Ref<const MatX>& forces) const {
  return far_->mesh_displacement(forces);
}

ContactCompliance::Nodes NearFieldCompliance::nodes(const Eigen::Ref<const MatX>& forces) const {
  return far_->nodes(forces);
}

}  // namespace stylet

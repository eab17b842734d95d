// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/display_near_field.hpp"

#include <algorithm>

namespace stylet {

namespace {

Shape shape_of(const SurfacePoint& point) {
  Shape shape;
  for (std::size_t k = 0; k < 3 && point.node[k] >= 0; ++k) {
    shape.node[k] = point.node[k];
    shape.weight[k] = point.weight[k];
    ++shape.count;
  }
  return shape;
}

bool same_place(const TissueForce& a, const TissueForce& b) {
  return a.at.tet == b.at.tet && a.at.weights == b.at.weights && a.along == b.along;
}

}  // namespace

DisplayNearField::DisplayNearField(std::shared_ptr<const Model> model, std::span<const SurfacePoint> points)
    : model_(std::move(model)), needle_{model_->coupling().needle_radius_mm, model_->coupling().spacing_mm} {
  const MeshKernel* kernel = model_->kernel().get();
  if (kernel == nullptr) return;
  const Tissue& tissue = model_->tissue();
  std::vector<Index> slot(static_cast<std::size_t>(tissue.displacement_nodes()), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Shape shape = shape_of(points[i]);
    const std::span used(shape.node.data(), static_cast<std::size_t>(shape.count));
    if (!std::all_of(used.begin(), used.end(), [&](Index node) { return kernel->has(node); })) continue;
    Vec3 x = Vec3::Zero();
    std::array<std::size_t, 3> slots{};
    for (std::size_t k = 0; k < used.size(); ++k) {
      x += shape.weight[k] * tissue.node_position(used[k]);
      Index& known = slot[static_cast<std::size_t>(used[k])];
      if (known < 0) {
        known = static_cast<Index>(nodes_.size());
        nodes_.push_back(used[k]);
      }
      slots[k] = static_cast<std::size_t>(known);
    }
    const NearPlace place = passive_place(tissue, *kernel, shape, x);
    if (place.moves == 0.0) continue;
    numbers_.push_back(static_cast<Eigen::Index>(i));
    places_.push_back(place);
    node_slots_.push_back(slots);
  }
  of_node_.resize(nodes_.size());
  moved_ = Eigen::VectorXf::Zero(3 * static_cast<Eigen::Index>(places_.size()));
}

/// The slot with the blocks of a force at this place. A new place takes an unused slot, or a new one if all are used.
std::size_t DisplayNearField::slot_for(const TissueForce& force) {
  auto found =
      std::find_if(sources_.begin(), sources_.end(), [&](const Source& s) { return same_place(s.force, force); });
  const bool known = found != sources_.end();
  if (!known) found = std::find_if(sources_.begin(), sources_.end(), [](const Source& s) { return !s.used; });
  const auto slot = static_cast<std::size_t>(found - sources_.begin());
  if (found == sources_.end()) {
    sources_.push_back({});
    blocks_.conservativeResize(moved_.size(), 3 * static_cast<Eigen::Index>(sources_.size()));
    if (knows_wide()) narrow_.conservativeResize(blocks_.rows(), blocks_.cols());
  }
  sources_[slot] = {force, true};
  if (!known) compute(slot);
  return slot;
}

NearPlace DisplayNearField::place_of(const TissueForce& force) const {
  const MeshKernel& kernel = *model_->kernel();
  const Tissue& tissue = model_->tissue();
  const auto& corners = tissue.mesh().tets[static_cast<std::size_t>(force.at.tet)];
  Vec3 x = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    x += force.at.weights[static_cast<Eigen::Index>(i)] * tissue.mesh().nodes[static_cast<std::size_t>(corners[i])];
  NearPlace on = near_place(tissue, kernel, force.at, x);
  if (force.along.isZero(0.0)) {
    take_tip_radii(needle_, kernel, on);
  } else {
    on.epsilon = needle_.shaft_epsilon();
    on.piece.direction = force.along;
    on.piece.length = needle_.segment_mm;
  }
  return on;
}

bool DisplayNearField::knows_wide() const {
  const auto& laws = model_->laws();
  return model_->coupling().creep.is_any() ||
         (knows_stiffening(model_->coupling()) &&
          std::any_of(laws.begin(), laws.end(), [](const RegionLaws& law) { return law.stiffening_MPa > 0.0; }));
}

/// Subtracts the part of the linear displacement under the tip by which stiffening tissue moves less.
void DisplayNearField::stiffen(const TissueForce& tip, std::size_t slot) {
  if (!knows_wide()) return;
  const NearPlace on = place_of(tip);
  const double stiffening_MPa =
      stiffening_of(on, [&](int region) { return model_->laws()[static_cast<std::size_t>(region)].stiffening_MPa; });
  if (stiffening_MPa == 0.0 || !knows_stiffening(model_->coupling())) return;
  const MeshKernel& kernel = *model_->kernel();
  const Mat3& g = on.mesh_kernel;
  const Mat3 own = tip_correction(kernel, on, g) - tip.softness * tip_wide_correction(kernel, on, g);
  const Vec3 press = tip.force - tip.lasting;
  const Vec3 spared = press - TipDent{0.5 * (own + own.transpose()), stiffening_MPa}.under(press).linear;
  moved_.noalias() -= narrow_.middleCols<3>(3 * static_cast<Eigen::Index>(slot)).lazyProduct(spared.cast<float>());
}

void DisplayNearField::compute(std::size_t slot) {
  const MeshKernel& kernel = *model_->kernel();
  const NearPlace on = place_of(sources_[slot].force);
  const double softness = sources_[slot].force.softness;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Shape node{.count = 1, .node = {nodes_[n]}, .weight = {1.0}};
    of_node_[n] = mesh_kernel_between(kernel, node, on.shape, on.medium);
  }
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const NearPlace here = acted_on_by(places_[p], on);
    const auto g = [&](int /*medium*/) {
      Mat3 sum = Mat3::Zero();
      for (std::size_t k = 0; k < static_cast<std::size_t>(here.shape.count); ++k)
        sum += here.shape.weight[k] * of_node_[node_slots_[p][k]];
      return sum;
    };
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(p);
    const Eigen::Index column = 3 * static_cast<Eigen::Index>(slot);
    const Mat3 near = near_correction(kernel, here, on, g);
    blocks_.block<3, 3>(row, column) = near.cast<float>();
    if (narrow_.size() > 0)
      narrow_.block<3, 3>(row, column) = (near - softness * wide_correction(kernel, here, on, g)).cast<float>();
  }
}

void DisplayNearField::set(std::span<const TissueForce> forces) {
  moved_.setZero();
  left_out_N_ = 0.0;
  if (places_.empty()) return;
  const MeshKernel& kernel = *model_->kernel();
  // Mark the slots of unchanged places first, so that no new place takes one of them.
  for (Source& source : sources_) {
    source.used = std::any_of(forces.begin(), forces.end(),
                              [&](const TissueForce& f) { return f.at.tet >= 0 && same_place(source.force, f); });
  }
  for (const TissueForce& force : forces) {
    if (force.at.tet < 0) continue;
    const auto nodes = model_->tissue().nodes_of(force.at.tet);
    if (!std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return kernel.has(node); })) {
      left_out_N_ += force.force.norm();
      continue;
    }
    const std::size_t slot = slot_for(force);
    moved_.noalias() +=
        blocks_.middleCols<3>(3 * static_cast<Eigen::Index>(slot)).lazyProduct(force.force.cast<float>());
    if (!force.lasting.isZero(0.0))
      moved_.noalias() -=
          narrow_.middleCols<3>(3 * static_cast<Eigen::Index>(slot)).lazyProduct(force.lasting.cast<float>());
    if (force.along.isZero(0.0)) stiffen(force, slot);
  }
}

void DisplayNearField::add(Eigen::Ref<Eigen::Matrix3Xf> u) const {
  for (std::size_t p = 0; p < numbers_.size(); ++p)
    u.col(numbers_[p]) += moved_.segment<3>(3 * static_cast<Eigen::Index>(p));
}

}  // namespace stylet

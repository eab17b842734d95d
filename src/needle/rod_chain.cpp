// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/condense_columns.hpp"
#include "needle/rod_chain_parts.hpp"

#include <cassert>
#include <utility>

namespace stylet {

RodChain::RodChain(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
RodChain::~RodChain() = default;

double RodChain::length() const { return parts_->length; }

void RodChain::set_base(const Pose& base) {
  parts_->base = base;
  parts_->base.rotation.normalize();
  parts_->base_rotation = parts_->base.rotation.toRotationMatrix();
}

const Pose& RodChain::base() const { return parts_->base; }

Vec3 RodChain::point(double s) const { return parts_->base.origin + parts_->base_rotation * parts_->shape.point(s); }

Vec3 RodChain::tangent(double s) const { return parts_->base_rotation * parts_->shape.tangent(s); }

AxisPlace RodChain::place(double s) const {
  const AxisPlace at = parts_->shape.place(s);
  return {parts_->base.origin + parts_->base_rotation * at.point, parts_->base_rotation * at.tangent};
}

bool RodChain::linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                         std::span<const Mat3> springs, Indefinite otherwise) {
  if (!parts_->tangent.assemble(parts_->shape, parts_->base_rotation, loads, springs, otherwise)) return false;
  parts_->tangent.condense(compliance, free);
  return parts_->tangent.elastic_shift() == 0.0;
}

bool RodChain::append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) {
  return parts_->tangent.append(parts_->shape, parts_->base_rotation, loads, compliance);
}

bool RodChain::relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) {
  return parts_->tangent.relax(parts_->shape, parts_->base_rotation, loads, free);
}

bool RodChain::prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) {
  parts_->preparing = Parts::Preparing::solution;
  return parts_->prepared.factorise(parts_->shape, parts_->base_rotation, loads, springs, otherwise) &&
         parts_->prepared.elastic_shift() == 0.0;
}

bool RodChain::prepared_compliance(Eigen::Ref<MatX> compliance) {
  using Preparing = Parts::Preparing;
  assert(parts_->preparing != Preparing::nothing);
  beam::BeamTangent& tangent = parts_->prepared;
  // The first seven tenths of the loads make half of the triangle. With few loads there is only one part.
  const Eigen::Index half = tangent.load_count() * 7 / 10 / kCondensed * kCondensed;
  switch (parts_->preparing) {
    case Preparing::solution:
      tangent.solve();
      parts_->preparing = half > 0 ? Preparing::first_loads : Preparing::last_loads;
      break;
    case Preparing::first_loads:
      tangent.condense(compliance, 0, half);
      parts_->preparing = Preparing::last_loads;
      break;
    case Preparing::last_loads:
      tangent.condense(compliance, half, tangent.load_count());
      parts_->preparing = Preparing::complete;
      break;
    default:
      break;
  }
  return parts_->preparing == Preparing::complete;
}

void RodChain::take_prepared() {
  assert(parts_->preparing == Parts::Preparing::complete);
  std::swap(parts_->tangent, parts_->prepared);
  parts_->preparing = Parts::Preparing::nothing;
}

void RodChain::advance(std::span<const PointLoad> loads) {
  parts_->tangent.step(loads, parts_->shape);
  parts_->shape.update();
}

double RodChain::residual(std::span<const PointLoad> loads) {
  return parts_->tangent.largest_imbalance(parts_->shape, parts_->base_rotation, loads);
}

void RodChain::damp(double ratio) {
  parts_->shape.damped_from = parts_->shape.curvature;
  parts_->shape.damping = ratio;
}

void RodChain::straighten() {
  parts_->shape.curvature = parts_->shape.rest;
  parts_->shape.update();
}

double RodChain::energy() const { return parts_->shape.energy(); }

Eigen::Ref<const VecX> RodChain::state() const { return parts_->shape.curvature; }

void RodChain::set_state(const Eigen::Ref<const VecX>& state) {
  parts_->shape.curvature = state;
  parts_->shape.update();
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/guided.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet {

GuidedNeedle::GuidedNeedle(std::unique_ptr<Needle> inner, const GuideHole& hole, int load_capacity)
    : inner_(std::move(inner)), hole_(hole), change_(3 * (static_cast<Eigen::Index>(load_capacity) + 1)) {
  const auto loads = static_cast<std::size_t>(load_capacity) + 1;
  loads_.reserve(loads);
  springs_.reserve(loads);
  const auto size = 3 * static_cast<Eigen::Index>(loads);
  N_.setZero(size, size);
  prepared_N_ = N_;
  free_.setZero(size);
}

void GuidedNeedle::place_guide(const Vec3& hole, const Vec3& axis) {
  hole_.place(hole, axis.normalized());
  hole_.meet(*inner_);
}

/// Puts the hole's load before the caller's loads, because these are added and dropped at the end of the list.
std::span<const PointLoad> GuidedNeedle::with_guide(std::span<const PointLoad> loads, const PointLoad& guide) {
  loads_.assign(1, guide);
  loads_.insert(loads_.end(), loads.begin(), loads.end());
  return loads_;
}

/// Puts the hole's stiffness before the caller's springs. @param springs one for each of the loads, or empty
std::span<const Mat3> GuidedNeedle::with_guide(std::span<const Mat3> springs, std::size_t loads) {
  assert(springs.empty() || springs.size() == loads);
  springs_.assign(loads + 1, Mat3::Zero());
  springs_.front() = hole_.stiffness();
  std::copy(springs.begin(), springs.end(), springs_.begin() + 1);
  return springs_;
}

bool GuidedNeedle::linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                             std::span<const Mat3> springs, Indefinite otherwise) {
  held_ = hold();
  if (!held_.on) return inner_->linearise(loads, compliance, free, springs, otherwise);
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  const bool definite = inner_->linearise(with_guide(loads, held_.with), N_.topLeftCorner(size + 3, size + 3),
                                          free_.head(size + 3), with_guide(springs, loads.size()), otherwise);
  if (!definite && otherwise == Indefinite::give_up) return false;
  change_.take(N_.topLeftCorner(size + 3, 3));
  compliance = N_.block(3, 3, size, size);
  free = free_.segment(3, size);
  return definite;
}

bool GuidedNeedle::prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) {
  prepared_ = hold();
  if (!prepared_.on) return inner_->prepare(loads, springs, otherwise);
  return inner_->prepare(with_guide(loads, prepared_.with), with_guide(springs, loads.size()), otherwise);
}

bool GuidedNeedle::prepared_compliance(Eigen::Ref<MatX> compliance) {
  if (!prepared_.on) return inner_->prepared_compliance(compliance);
  const Eigen::Index size = compliance.rows();
  if (!inner_->prepared_compliance(prepared_N_.topLeftCorner(size + 3, size + 3))) return false;
  compliance = prepared_N_.block(3, 3, size, size);
  return true;
}

void GuidedNeedle::take_prepared() {
  inner_->take_prepared();
  held_ = prepared_;
  if (held_.on) change_.take(prepared_N_.leftCols<3>());
}

bool GuidedNeedle::fits() const {
  if (held_.on != hole_.has_held()) return false;
  return !held_.on || change_.is_small(hole_.stiffness() - held_.stiffness);
}

bool GuidedNeedle::append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) {
  if (!fits()) return false;
  if (!held_.on) return inner_->append(loads, compliance);
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  auto rows = N_.topLeftCorner(3, size + 3);
  if (!inner_->append(with_guide(loads, guide_load()), rows)) return false;
  change_.append(static_cast<Eigen::Index>(loads.size()), rows.leftCols<3>());
  compliance = rows.rightCols(size);
  return true;
}

bool GuidedNeedle::relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) {
  if (!fits()) return false;
  if (!held_.on) return inner_->relax(loads, free);
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  if (!inner_->relax(with_guide(loads, guide_load()), free_.head(size + 3))) return false;
  held_.with = guide_load();
  change_.begin(hole_.stiffness() - held_.stiffness, loads, free_.head<3>());
  free = free_.segment(3, size);
  free.noalias() += change_.by_hole(loads.size()).lazyProduct(change_.force());
  return true;
}

void GuidedNeedle::advance(std::span<const PointLoad> loads) {
  if (held_.on) {
    inner_->advance(with_guide(loads, {held_.with.s, held_.with.force + change_.force(loads)}));
  } else {
    inner_->advance(loads);
  }
  hole_.meet(*inner_);
}

double GuidedNeedle::residual(std::span<const PointLoad> loads) {
  return inner_->residual(hole_.holds() ? with_guide(loads, guide_load()) : loads);
}

void GuidedNeedle::set_base(const Pose& base) {
  inner_->set_base(base);
  hole_.meet(*inner_);
}

void GuidedNeedle::straighten() {
  inner_->straighten();
  hole_.meet(*inner_);
}

double GuidedNeedle::energy() const { return inner_->energy() + hole_.energy(); }

void GuidedNeedle::set_state(const Eigen::Ref<const VecX>& state) {
  inner_->set_state(state);
  hole_.meet(*inner_);
}

}  // namespace stylet

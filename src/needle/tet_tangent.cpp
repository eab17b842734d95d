// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/tet_tangent.hpp"

#include "needle/condense_columns.hpp"

#include <algorithm>
#include <cassert>

namespace stylet::tet {

namespace {

/// Smallest multiple of the material part that is tried as a shift. A larger one takes fewer attempts just beyond the
/// buckling load, but exceeds the necessary shift by more.
constexpr double kSmallestShift = 0.1;

/// Factor by which the shift grows from one attempt to the next. A larger factor has the same effects.
constexpr double kGrowth = 4.0;

/// A matrix that needs a larger shift is assumed not to be finite. A larger limit takes more attempts before that.
constexpr double kLargestShift = 1e12;

/// Position of the axis node's first unknown in the block of its layer.
constexpr int kAxis = 3 * kAxisNode;

}  // namespace

TetTangent::TetTangent(const TetShape& shape, int load_capacity)
    : stiffness_(shape),
      middle_(shape.mesh(), shape.segments()),
      band_(shape.segments()),
      gradient_(VecX::Zero(shape.displacement.size())),
      z_(VecX::Zero(kBlock * shape.segments())),
      step_(VecX::Zero(kBlock * shape.segments())) {
  reserve(load_capacity);
}

void TetTangent::reserve(Eigen::Index loads) {
  if (3 * loads <= Y_.cols()) return;
  Y_.setZero(z_.size(), 3 * loads);
  force_.setZero(3 * loads);
  loads_.reserve(static_cast<std::size_t>(loads));
}

bool TetTangent::assemble(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                          std::span<const Mat3> springs, Indefinite otherwise) {
  stiffness_.assemble(shape);
  assemble_loads(shape, base_rotation, loads);
  factorised_ = factorise_shifted(base_rotation, springs, otherwise);
  if (!factorised_) return false;
  middle_.reduce(gradient_, z_);
  band_.solve_lower(0, z_.data());
  const Mat3 to_base = base_rotation.transpose();
  for (std::size_t c = 0; c < loads_.size(); ++c) {
    const auto load = static_cast<Eigen::Index>(c);
    auto columns = Y_.middleCols<3>(3 * load);
    columns.setZero();
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      const double w = loads_[c].value[i];
      if (w != 0.0) columns.middleRows<3>(kBlock * (loads_[c].first + i - 1) + kAxis) = w * to_base;
    }
    const auto first = static_cast<int>(start(load, load + 1) / kBlock);
    for (int j = 0; j < 3; ++j) band_.solve_lower(first, columns.col(j).data());
  }
  return true;
}

void TetTangent::assemble_loads(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  reserve(static_cast<Eigen::Index>(loads.size()));
  loads_.clear();
  for (const PointLoad& load : loads) loads_.push_back(shape.curve().weights(load.s));
  assemble_gradient(shape, base_rotation, loads);
}

void TetTangent::assemble_gradient(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  gradient_ = shape.force();
  for (std::size_t c = 0; c < loads.size(); ++c) {
    force_.segment<3>(3 * static_cast<Eigen::Index>(c)) = loads[c].force;
    const AxisCurve::Weights w = shape.curve().weights(loads[c].s);
    const Vec3 force = base_rotation.transpose() * loads[c].force;
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      if (w.value[i] != 0.0) gradient_.segment<3>(shape.axis_dof(w.first + i)) -= w.value[i] * force;
    }
  }
}

bool TetTangent::relax(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                       Eigen::Ref<VecX> free) {
  if (!factorised_ || loads.size() > loads_.size()) return false;
  loads_.resize(loads.size());
  assemble_gradient(shape, base_rotation, loads);
  middle_.reduce(gradient_, z_);
  band_.solve_lower(0, z_.data());
  move_loads(free);
  return true;
}

bool TetTangent::factorise_shifted(const Mat3& base_rotation, std::span<const Mat3> springs, Indefinite otherwise) {
  const auto attempt = [&](double shift) {
    material_shift_ = shift;
    band_.clear();
    if (!springs.empty()) add_springs(base_rotation, springs);
    return factorise(shift);
  };
  if (attempt(0.0)) return true;
  if (otherwise == Indefinite::give_up) return false;
  // Beyond the buckling load. The first shift that works bounds the smallest eigenvalue; twice that shift leaves a
  // margin.
  for (double shift = kSmallestShift; shift < kLargestShift; shift *= kGrowth) {
    if (attempt(shift) && attempt(2.0 * shift)) return true;
  }
  // Only reached when loads or shape are not finite.
  band_.clear();
  for (int k = 0; k < band_.blocks(); ++k) band_.at(k, k).setIdentity();
  middle_.disconnect();
  return true;
}

/// Adds every segment to the blocks of its two layers, leaving out the clamped layer, and factorises the result.
bool TetTangent::factorise(double shift) {
  for (int k = 0; k < band_.blocks(); ++k) {
    if (!middle_.eliminate(k, stiffness_.segment(k), shift)) return false;
    band_.at(k, k) += middle_.left(1, 1);
    if (k == 0) continue;
    band_.at(k, k - 1) += middle_.left(1, 0);
    band_.at(k - 1, k - 1) += middle_.left(0, 0);
  }
  return band_.factorise();
}

/// Adds springs to the band. Four layers determine the cubic where a spring acts, so the spring couples layers up to
/// three apart.
void TetTangent::add_springs(const Mat3& base_rotation, std::span<const Mat3> springs) {
  assert(springs.size() == loads_.size());
  for (std::size_t c = 0; c < std::min(springs.size(), loads_.size()); ++c) {
    if (springs[c].isZero(0.0)) continue;
    const Mat3 G = base_rotation.transpose() * springs[c] * base_rotation;
    const AxisCurve::Weights& w = loads_[c];
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      for (int j = 0; j <= i; ++j) {
        if (w.value[i] == 0.0 || w.value[j] == 0.0) continue;
        band_.at(w.first + i - 1, w.first + j - 1).block<3, 3>(kAxis, kAxis) += w.value[i] * w.value[j] * G;
      }
    }
  }
}

Eigen::Index TetTangent::start(Eigen::Index first_load, Eigen::Index last_load) const {
  int first = band_.blocks();
  for (Eigen::Index c = first_load; c < last_load; ++c) {
    const AxisCurve::Weights& w = loads_[static_cast<std::size_t>(c)];
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      if (w.value[i] != 0.0) first = std::min(first, w.first + i - 1);
    }
  }
  return static_cast<Eigen::Index>(kBlock) * first;
}

void TetTangent::condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const {
  condense_columns(
      Y_, 0, static_cast<Eigen::Index>(loads_.size()), [this](Eigen::Index a, Eigen::Index b) { return start(a, b); },
      compliance);
  move_loads(free);
}

void TetTangent::move_loads(Eigen::Ref<VecX>& free) const {
  condense_gradient(
      Y_, z_, static_cast<Eigen::Index>(loads_.size()), [this](Eigen::Index a, Eigen::Index b) { return start(a, b); },
      free);
}

void TetTangent::step(std::span<const PointLoad> loads, TetShape& shape) {
  assert(loads.size() == loads_.size());
  step_ = -z_;
  for (std::size_t c = 0; c < std::min(loads.size(), loads_.size()); ++c) {
    const auto i = 3 * static_cast<Eigen::Index>(c);
    const Vec3 change = loads[c].force - force_.segment<3>(i);
    step_.noalias() += Y_.middleCols<3>(i).lazyProduct(change);
  }
  band_.solve_upper(step_.data());
  middle_.move(step_, shape.displacement);
}

}  // namespace stylet::tet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/beam_tangent.hpp"

#include "core/dense_cholesky.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet::beam {

using dense::factorise;
using dense::kTile;
using dense::solve_lower;
using dense::solve_upper;

namespace {

/// Sums over the loads beyond an element, about the base: Σ f and Σ r fᵀ.
struct Resultant {
  Vec3 force = Vec3::Zero();
  Mat3 tensor = Mat3::Zero();

  void add(const LocatedLoad& load) {
    force += load.force;
    tensor.noalias() += load.point * load.force.transpose();
  }
  /// Σ r × f
  [[nodiscard]] Vec3 moment() const {
    return {tensor(1, 2) - tensor(2, 1), tensor(2, 0) - tensor(0, 2), tensor(0, 1) - tensor(1, 0)};
  }
  /// Σ [f]×[r]× = Σ r fᵀ - (r·f) I
  [[nodiscard]] Mat3 double_cross() const {
    Mat3 m = tensor;
    m.diagonal().array() -= tensor.trace();
    return m;
  }
};

/// The Hessian is made positive definite with at least this share of the elastic part to spare.
constexpr double kSmallestShift = 0.05;

}  // namespace

double largest_imbalance(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  Resultant beyond;
  double largest = 0.0;
  for (int e = shape.elements() - 1; e >= 0; --e) {
    Vec3 generalised = shape.shift(e).transpose() * beyond.force + shape.spin(e).transpose() * beyond.moment();
    for (const PointLoad& load : loads) {
      if (shape.locate(load.s).element != e) continue;
      const LocatedLoad located = shape.locate_load(load.s, base_rotation.transpose() * load.force);
      generalised.noalias() += shape.inner_jacobian(located.at).transpose() * located.force;
      beyond.add(located);
    }
    const Vec3 moment = shape.stiffness().cwiseProduct(shape.kappa(e)) - generalised / shape.element_length();
    // Written so that a NaN is not lost.
    if (!(moment.norm() <= largest)) largest = moment.norm();
  }
  return largest;
}

BeamTangent::BeamTangent(const BeamShape& shape, int load_capacity)
    : elements_(shape.elements()),
      scale_((shape.element_length() * shape.stiffness()).cwiseSqrt().cwiseInverse()),
      H_(MatX::Zero(dof(elements_), dof(elements_))),
      L_(MatX::Identity(dof(elements_), dof(elements_))),
      g_(VecX::Zero(dof(elements_))),
      z_(VecX::Zero(dof(elements_))),
      step_(VecX::Zero(dof(elements_))),
      spin_(MatX::Zero(dof(elements_), 3)),
      shift_(MatX::Zero(dof(elements_), 3)),
      lever_(static_cast<std::size_t>(elements_), Mat3::Zero()) {
  reserve(load_capacity);
}

void BeamTangent::reserve(Eigen::Index loads) {
  if (3 * loads <= Y_.cols()) return;
  Y_.setZero(dof(elements_), 3 * loads);
  force_.setZero(3 * loads);
  loads_.reserve(static_cast<std::size_t>(loads));
}

void BeamTangent::assemble(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                           std::span<const Mat3> springs) {
  locate(shape, base_rotation, loads);
  assemble_energy(shape);
  assemble_jacobian(shape, base_rotation);
  if (!springs.empty()) add_springs(springs);
  factorise_shifted();
  z_ = g_;
  solve_lower(L_, 0, z_);
  solve_jacobian();
}

void BeamTangent::locate(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  reserve(static_cast<Eigen::Index>(loads.size()));
  loads_.clear();
  for (const PointLoad& load : loads) {
    force_.segment<3>(3 * static_cast<Eigen::Index>(loads_.size())) = load.force;
    loads_.push_back(shape.locate_load(load.s, base_rotation.transpose() * load.force));
  }
}

void BeamTangent::assemble_energy(const BeamShape& shape) {
  const double l = shape.element_length();
  const auto scale = scale_.asDiagonal();
  Resultant beyond;
  for (int e = elements_ - 1; e >= 0; --e) {
    const Eigen::Index i = row(e);
    const Mat3 Rt = shape.frame(e).transpose();
    const Mat3 spin = shape.spin(e) * scale;
    const Mat3 shift = shape.shift(e) * scale;
    spin_.middleRows<3>(i) = spin.transpose();
    shift_.middleRows<3>(i) = shift.transpose();

    // Loads beyond the element: its end moves by its chord, and all beyond turns with its end frame.
    const RotationTerms terms(l * shape.kappa(e));
    const Vec3 force = Rt * beyond.force;
    const Mat3 turning =
        Rt * (beyond.tensor.transpose() - beyond.force * shape.origin(e + 1).transpose()) * shape.frame(e + 1);
    Mat3 second = l * l * (l * terms.chord_hessian(force) + terms.rotation_hessian(turning));
    Vec3 generalised = shift.transpose() * beyond.force + spin.transpose() * beyond.moment();
    Mat3 lever = cross(beyond.force) * shift - beyond.double_cross() * spin;

    for (const LocatedLoad& load : loads_) {
      if (load.at.element != e) continue;
      const double s = load.at.local;
      const RotationTerms inner(s * shape.kappa(e));
      const Mat3 jacobian = s * s * (shape.frame(e) * inner.chord_derivative()) * scale;
      second += s * s * s * inner.chord_hessian(Rt * load.force);
      generalised.noalias() += jacobian.transpose() * load.force;
      lever.noalias() += cross(load.force) * jacobian;
      beyond.add(load);
    }

    g_.segment<3>(i) = shape.kappa(e).cwiseQuotient(scale_) - generalised;
    H_.block<3, 3>(i, i) = Mat3::Identity() - scale * second * scale;
    lever_[e] = lever;
  }
  // An element a nearer the base turns the whole lever of element e: ∂²Π/∂y_a∂y_e = Ω_aᵀ Σ_c [f_c]× ∂r_c/∂y_e.
  for (int e = elements_ - 1; e >= 1; --e) {
    const Eigen::Index i = row(e) + 3;
    H_.block(i, i - 3, H_.rows() - i, 3).noalias() = spin_.bottomRows(H_.rows() - i).lazyProduct(lever_[e]);
  }
}

void BeamTangent::factorise_shifted() {
  const auto attempt = [this](double shift) {
    L_.triangularView<Eigen::Lower>() = H_;
    L_.diagonal().array() += shift;
    elastic_shift_ = shift;
    return factorise(L_);
  };
  if (attempt(0.0)) return;
  // Beyond buckling. The first shift that works bounds the smallest eigenvalue; twice that shift leaves a margin.
  for (double shift = kSmallestShift; shift < 1e12; shift *= 2.0) {
    if (attempt(shift) && attempt(2.0 * shift)) return;
  }
  // Only reached when loads or shape are not finite.
  L_.setIdentity();
}

void BeamTangent::assemble_jacobian(const BeamShape& shape, const Mat3& base_rotation) {
  const Mat3 to_base = base_rotation.transpose();
  const Eigen::Index rows = Y_.rows();
  for (std::size_t c = 0; c < loads_.size(); ++c) {
    const LocatedLoad& load = loads_[c];
    auto column = Y_.middleCols<3>(3 * static_cast<Eigen::Index>(c));
    if (load.at.element < 0) {
      column.setZero();
      continue;
    }
    const Eigen::Index i = row(load.at.element);
    const Eigen::Index below = rows - i - 3;
    const Mat3 turned = cross(load.point) * to_base;
    column.topRows(i).setZero();
    column.middleRows<3>(i).noalias() = scale_.asDiagonal() * (shape.inner_jacobian(load.at).transpose() * to_base);
    column.bottomRows(below).noalias() = shift_.bottomRows(below).lazyProduct(to_base);
    column.bottomRows(below).noalias() += spin_.bottomRows(below).lazyProduct(turned);
  }
}

void BeamTangent::add_springs(std::span<const Mat3> springs) {
  assert(springs.size() == loads_.size());
  for (std::size_t c = 0; c < loads_.size(); ++c) {
    const int e = loads_[c].at.element;
    if (e < 0 || springs[c].isZero(0.0)) continue;
    const Eigen::Index reach = Y_.rows() - row(e);
    const auto motion = Y_.middleCols<3>(3 * static_cast<Eigen::Index>(c)).bottomRows(reach);
    auto corner = H_.bottomRightCorner(reach, reach);
    // Column by column, the lower triangle only: three multiplications an entry and no work space.
    for (Eigen::Index j = 0; j < reach; ++j) {
      const Vec3 pull = springs[c] * motion.row(j).transpose();
      corner.col(j).tail(reach - j).noalias() += motion.bottomRows(reach - j).lazyProduct(pull);
    }
  }
}

void BeamTangent::solve_jacobian() {
  const auto count = static_cast<Eigen::Index>(loads_.size());
  constexpr Eigen::Index stride = kTile / 3;
  for (Eigen::Index c = 0; c < count; c += stride) {
    const Eigen::Index last = std::min(count, c + stride);
    solve_lower(L_, start(c, last), Y_.middleCols(3 * c, 3 * (last - c)));
  }
}

Eigen::Index BeamTangent::start(Eigen::Index first_load, Eigen::Index last_load) const {
  Eigen::Index first_row = Y_.rows();
  for (Eigen::Index c = first_load; c < last_load; ++c) {
    const int e = loads_[static_cast<std::size_t>(c)].at.element;
    if (e >= 0) first_row = std::min(first_row, row(e));
  }
  return first_row;
}

void BeamTangent::condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const {
  const auto count = static_cast<Eigen::Index>(loads_.size());
  assert(compliance.rows() == 3 * count && compliance.cols() == 3 * count && free.size() == 3 * count);
  constexpr Eigen::Index stride = kTile / 3;
  for (Eigen::Index a = 0; a < count; a += stride) {
    const Eigen::Index na = std::min(stride, count - a);
    const Eigen::Index start_a = start(a, a + na);
    const auto columns = Y_.middleCols(3 * a, 3 * na);
    auto motion = free.segment(3 * a, 3 * na);
    motion.noalias() = columns.transpose() * z_;
    motion = -motion;
    for (Eigen::Index b = 0; b <= a; b += stride) {
      const Eigen::Index nb = std::min(stride, count - b);
      const Eigen::Index depth = Y_.rows() - std::max(start_a, start(b, b + nb));
      auto tile = compliance.block(3 * a, 3 * b, 3 * na, 3 * nb);
      tile.noalias() = columns.bottomRows(depth).transpose() * Y_.middleCols(3 * b, 3 * nb).bottomRows(depth);
      if (a == b) {
        tile.triangularView<Eigen::StrictlyUpper>() = tile.transpose();
      } else {
        compliance.block(3 * b, 3 * a, 3 * nb, 3 * na) = tile.transpose();
      }
    }
  }
}

void BeamTangent::step(std::span<const PointLoad> loads, BeamShape& shape) {
  assert(loads.size() == loads_.size());
  step_ = -z_;
  const std::size_t count = std::min(loads.size(), loads_.size());
  for (std::size_t c = 0; c < count; ++c) {
    const auto i = 3 * static_cast<Eigen::Index>(c);
    const Vec3 change = loads[c].force - force_.segment<3>(i);
    const int e = loads_[c].at.element;
    if (e < 0) continue;
    const Eigen::Index reach = Y_.rows() - row(e);
    step_.tail(reach).noalias() += Y_.middleCols<3>(i).bottomRows(reach).lazyProduct(change);
  }
  solve_upper(L_, step_);
  for (int e = 0; e < elements_; ++e)
    shape.curvature.segment<3>(dof(e)) += scale_.cwiseProduct(step_.segment<3>(row(e)));
}

VecX BeamTangent::gradient() const {
  VecX gradient(g_.size());
  for (int e = 0; e < elements_; ++e) gradient.segment<3>(dof(e)) = g_.segment<3>(row(e)).cwiseQuotient(scale_);
  return gradient;
}

MatX BeamTangent::hessian() const {
  const MatX full = H_.selfadjointView<Eigen::Lower>();
  MatX hessian(full.rows(), full.cols());
  const Vec3 inverse = scale_.cwiseInverse();
  for (int a = 0; a < elements_; ++a) {
    for (int b = 0; b < elements_; ++b) {
      hessian.block<3, 3>(dof(a), dof(b)) =
          inverse.asDiagonal() * full.block<3, 3>(row(a), row(b)) * inverse.asDiagonal();
    }
  }
  return hessian;
}

}  // namespace stylet::beam

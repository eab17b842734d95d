// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/beam_tangent.hpp"

#include "core/dense_kernels.hpp"
#include "core/largest.hpp"
#include "needle/condense_columns.hpp"
#include "needle/resultant.hpp"

#include <algorithm>
#include <cassert>

namespace stylet::beam {

BeamTangent::BeamTangent(const BeamShape& shape, int load_capacity)
    : chain_(shape),
      work_(shape.elements()),
      hessian_(chain_.rows()),
      g_(VecX::Zero(chain_.rows())),
      z_(VecX::Zero(chain_.rows())),
      step_(VecX::Zero(chain_.rows())),
      lever_(static_cast<std::size_t>(shape.elements()), Mat3::Zero()) {
  reserve(load_capacity);
}

void BeamTangent::reserve(Eigen::Index loads) {
  if (3 * loads <= Y_.cols()) return;
  Y_.setZero(chain_.rows(), 3 * loads);
  force_.setZero(3 * loads);
  less_.setZero(3 * loads);
  loads_.reserve(loads);
  work_.reserve(loads);
}

bool BeamTangent::assemble(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                           std::span<const Mat3> springs, Indefinite otherwise) {
  if (!factorise(shape, base_rotation, loads, springs, otherwise)) return false;
  solve();
  return true;
}

bool BeamTangent::factorise(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                            std::span<const Mat3> springs, Indefinite otherwise) {
  reserve(static_cast<Eigen::Index>(loads.size()));
  loads_.keep_first(0);
  for (const PointLoad& load : loads) add_load(shape, base_rotation, load);
  chain_.update(shape);
  assemble_energy(shape);
  for (Eigen::Index c = 0; c < load_count(); ++c) chain_.motion(loads_.of(c), base_rotation, Y_.middleCols<3>(3 * c));
  if (!springs.empty()) add_springs(springs);
  return hessian_.factorise(otherwise);
}

void BeamTangent::solve() {
  z_ = g_;
  hessian_.solve_lower(0, z_);
  for_groups([&](Eigen::Index first, Eigen::Index count, Eigen::Index reach) {
    hessian_.solve_lower(Y_.rows() - reach, Y_.middleCols(first, count));
  });
}

double BeamTangent::largest_imbalance(const BeamShape& shape, const Mat3& base_rotation,
                                      std::span<const PointLoad> loads) {
  reserve(static_cast<Eigen::Index>(loads.size()));
  const std::span<const Vec3> work = work_.of(shape, base_rotation, loads);
  double largest = 0.0;
  for (int e = 0; e < shape.elements(); ++e) {
    const Vec3 moment = shape.elastic_weight(e) * shape.stiffness().cwiseProduct(shape.moment_strain(e)) -
                        work[static_cast<std::size_t>(e)] / shape.element_length();
    largest = larger_or_nan(largest, moment.norm());
  }
  return largest;
}

bool BeamTangent::relax(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                        Eigen::Ref<VecX> free) {
  const auto count = static_cast<Eigen::Index>(loads.size());
  if (!hessian_.factorised() || count > load_count()) return false;
  loads_.keep_first(count);
  const std::span<const Vec3> work = work_.of(shape, base_rotation, loads);
  for (int e = 0; e < shape.elements(); ++e) {
    const Vec3& scale = chain_.scale(e);
    g_.segment<3>(chain_.row(e)) =
        shape.moment_strain(e).cwiseQuotient(scale) - scale.cwiseProduct(work[static_cast<std::size_t>(e)]);
  }
  for (std::size_t c = 0; c < loads.size(); ++c) force_.segment<3>(3 * static_cast<Eigen::Index>(c)) = loads[c].force;
  z_ = g_;
  hessian_.solve_lower(0, z_);
  move_loads(free);
  return true;
}

/// Adds a load at the end, with its force.
void BeamTangent::add_load(const BeamShape& shape, const Mat3& base_rotation, const PointLoad& load) {
  force_.segment<3>(3 * load_count()) = load.force;
  loads_.add(shape, base_rotation, load);
}

bool BeamTangent::append(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                         Eigen::Ref<MatX> compliance) {
  const auto count = static_cast<Eigen::Index>(loads.size());
  if (!hessian_.factorised() || count > load_count() + 1 || 3 * count > Y_.cols()) return false;
  loads_.keep_first(count - 1);
  add_load(shape, base_rotation, loads.back());
  const Eigen::Index c = count - 1;
  auto column = Y_.middleCols<3>(3 * c);
  chain_.motion(loads_.of(c), base_rotation, column);
  const Eigen::Index first = start(c, c + 1);
  hessian_.solve_lower(first, column);
  const Eigen::Index reach = Y_.rows() - first;
  compliance.noalias() = column.bottomRows(reach).transpose().lazyProduct(Y_.leftCols(3 * count).bottomRows(reach));
  return true;
}

void BeamTangent::assemble_energy(const BeamShape& shape) {
  MatX& H = hessian_.matrix();
  const double l = shape.element_length();
  Resultant beyond;
  for (int e = shape.elements() - 1; e >= 0; --e) {
    const auto scale = chain_.scale(e).asDiagonal();
    const Eigen::Index i = chain_.row(e);
    const Mat3 Rt = shape.frame(e).transpose();
    const Mat3 spin = chain_.spin(e);
    const Mat3 shift = chain_.shift(e);

    // Loads beyond the element: its end moves by its chord, and everything beyond rotates with its end frame.
    const RotationTerms terms = shape.terms({e, l});
    const Vec3 force = Rt * beyond.force;
    const Mat3 turning =
        Rt * (beyond.tensor.transpose() - beyond.force * shape.origin(e + 1).transpose()) * shape.frame(e + 1);
    Mat3 second = l * l * (l * terms.chord_hessian(force) + terms.rotation_hessian(turning));
    Vec3 generalised = shift.transpose() * beyond.force + spin.transpose() * beyond.moment();
    Mat3 lever = cross(beyond.force) * shift - beyond.double_cross() * spin;

    for (const Pull& pull : loads_.all()) {
      if (pull.at.element != e) continue;
      const double s = pull.at.local;
      const RotationTerms inner = shape.terms(pull.at);
      const Mat3 jacobian = pull.jacobian * scale;
      second += s * s * s * inner.chord_hessian(Rt * pull.force);
      generalised.noalias() += jacobian.transpose() * pull.force;
      lever.noalias() += cross(pull.force) * jacobian;
      beyond.add(pull);
    }

    g_.segment<3>(i) = shape.moment_strain(e).cwiseQuotient(chain_.scale(e)) - generalised;
    H.block<3, 3>(i, i) = (1.0 + shape.damping) * Mat3::Identity() - scale * second * scale;
    lever_[e] = lever;
  }
  // An element a nearer to the base rotates the whole lever of element e: ∂²Π/∂y_a∂y_e = Ω_aᵀ Σ_c [f_c]× ∂r_c/∂y_e.
  for (int e = shape.elements() - 1; e >= 1; --e) {
    const Eigen::Index i = chain_.row(e) + 3;
    H.block(i, i - 3, H.rows() - i, 3).noalias() = chain_.spins().bottomRows(H.rows() - i).lazyProduct(lever_[e]);
  }
}

void BeamTangent::add_springs(std::span<const Mat3> springs) {
  assert(static_cast<Eigen::Index>(springs.size()) == load_count());
  for (Eigen::Index c = 0; c < load_count(); ++c) {
    const Mat3& spring = springs[static_cast<std::size_t>(c)];
    const int e = loads_.last_moved(c);
    if (e < 0 || spring.isZero(0.0)) continue;
    const Eigen::Index reach = Y_.rows() - chain_.row(e);
    const auto motion = Y_.middleCols<3>(3 * c).bottomRows(reach);
    auto corner = hessian_.matrix().bottomRightCorner(reach, reach);
    // Column by column and only in the lower triangle: three multiplications per entry, and no work space.
    for (Eigen::Index j = 0; j < reach; ++j) {
      const Vec3 pull = spring * motion.row(j).transpose();
      corner.col(j).tail(reach - j).noalias() += motion.bottomRows(reach - j).lazyProduct(pull);
    }
  }
}

/// Calls function(first column, number of columns, number of last rows that are not zero) for groups of loads.
template <class Function>
void BeamTangent::for_groups(Function&& function) const {
  for (Eigen::Index c = 0; c < load_count(); c += kCondensed) {
    const Eigen::Index last = std::min(load_count(), c + kCondensed);
    function(3 * c, 3 * (last - c), Y_.rows() - start(c, last));
  }
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): written through the view
void BeamTangent::condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const {
  condense(compliance, 0, load_count());
  move_loads(free);
}

void BeamTangent::condense(Eigen::Ref<MatX> compliance, Eigen::Index first, Eigen::Index last) const {
  condense_columns(
      Y_, first, last, [this](Eigen::Index a, Eigen::Index b) { return start(a, b); }, compliance);
}

void BeamTangent::move_loads(Eigen::Ref<VecX>& free) const {
  condense_gradient(
      Y_, z_, load_count(), [this](Eigen::Index a, Eigen::Index b) { return start(a, b); }, free);
}

void BeamTangent::step(std::span<const PointLoad> loads, BeamShape& shape) {
  assert(static_cast<Eigen::Index>(loads.size()) == load_count());
  for (std::size_t c = 0; c < loads.size(); ++c) {
    const auto i = 3 * static_cast<Eigen::Index>(c);
    less_.segment<3>(i) = force_.segment<3>(i) - loads[c].force;
  }
  step_ = -z_;
  for_groups([&](Eigen::Index first, Eigen::Index count, Eigen::Index reach) {
    dense::subtract_product(step_.tail(reach), Y_.block(Y_.rows() - reach, first, reach, count),
                            less_.segment(first, count));
  });
  hessian_.solve_upper(step_);
  for (int e = 0; e < shape.elements(); ++e)
    shape.curvature.segment<3>(dof(e)) += chain_.scale(e).cwiseProduct(step_.segment<3>(chain_.row(e)));
}

VecX BeamTangent::gradient() const {
  VecX gradient(g_.size());
  for (int e = 0; e < chain_.elements(); ++e)
    gradient.segment<3>(dof(e)) = g_.segment<3>(chain_.row(e)).cwiseQuotient(chain_.scale(e));
  return gradient;
}

MatX BeamTangent::hessian() const {
  const MatX full = hessian_.matrix().selfadjointView<Eigen::Lower>();
  MatX hessian(full.rows(), full.cols());
  for (int a = 0; a < chain_.elements(); ++a) {
    for (int b = 0; b < chain_.elements(); ++b) {
      hessian.block<3, 3>(dof(a), dof(b)) = chain_.scale(a).cwiseInverse().asDiagonal() *
                                            full.block<3, 3>(chain_.row(a), chain_.row(b)) *
                                            chain_.scale(b).cwiseInverse().asDiagonal();
    }
  }
  return hessian;
}

}  // namespace stylet::beam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/beam_tangent.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"
#include "core/largest.hpp"
#include "needle/condense_columns.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet::beam {

using dense::solve_lower;
using dense::solve_upper;

namespace {

/// Sums over the loads beyond an element, about the base: Σ f and Σ r fᵀ.
struct Resultant {
  Vec3 force = Vec3::Zero();
  Mat3 tensor = Mat3::Zero();

  void add(const Pull& pull) {
    force += pull.force;
    tensor.noalias() += pull.point * pull.force.transpose();
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

BeamTangent::BeamTangent(const BeamShape& shape, int load_capacity)
    : elements_(shape.elements()),
      scale_(static_cast<std::size_t>(elements_)),
      first_(static_cast<std::size_t>(elements_)),
      work_(static_cast<std::size_t>(elements_)),
      H_(MatX::Zero(dof(elements_), dof(elements_))),
      L_(MatX::Identity(dof(elements_), dof(elements_))),
      g_(VecX::Zero(dof(elements_))),
      z_(VecX::Zero(dof(elements_))),
      step_(VecX::Zero(dof(elements_))),
      spin_(MatX::Zero(dof(elements_), 3)),
      shift_(MatX::Zero(dof(elements_), 3)),
      lever_(static_cast<std::size_t>(elements_), Mat3::Zero()) {
  const Vec3 standard = (shape.element_length() * shape.stiffness()).cwiseSqrt().cwiseInverse();
  for (int e = 0; e < elements_; ++e)
    scale_[static_cast<std::size_t>(e)] = standard / std::sqrt(shape.elastic_weight(e));
  reserve(load_capacity);
}

void BeamTangent::reserve(Eigen::Index loads) {
  if (3 * loads <= Y_.cols()) return;
  Y_.setZero(dof(elements_), 3 * loads);
  force_.setZero(3 * loads);
  less_.setZero(3 * loads);
  pulls_.reserve(static_cast<std::size_t>(AxisCurve::kReach * loads));
  acting_.reserve(static_cast<std::size_t>(AxisCurve::kReach * loads));
  next_.reserve(static_cast<std::size_t>(AxisCurve::kReach * loads));
  work_loads_.reserve(static_cast<std::size_t>(loads));
  last_pull_.reserve(static_cast<std::size_t>(loads));
  last_moved_.reserve(static_cast<std::size_t>(loads));
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
  keep_first(0);
  for (const PointLoad& load : loads) locate(shape, base_rotation, load);
  assemble_energy(shape);
  for (Eigen::Index c = 0; c < load_count(); ++c) assemble_jacobian(base_rotation, c);
  if (!springs.empty()) add_springs(springs);
  factorised_ = factorise_shifted(otherwise);
  return factorised_;
}

void BeamTangent::solve() {
  z_ = g_;
  solve_lower(L_, 0, z_);
  for_groups([&](Eigen::Index first, Eigen::Index count, Eigen::Index reach) {
    solve_lower(L_, Y_.rows() - reach, Y_.middleCols(first, count));
  });
}

/// Virtual work of the loads per curvature of each element. The same question comes twice in an iteration.
void BeamTangent::sum_work(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  const auto same = [](const PointLoad& a, const PointLoad& b) { return a.s == b.s && a.force == b.force; };
  if (work_revision_ == shape.revision() && work_rotation_ == base_rotation &&
      std::equal(loads.begin(), loads.end(), work_loads_.begin(), work_loads_.end(), same))
    return;
  work_revision_ = shape.revision();
  work_rotation_ = base_rotation;
  work_loads_.assign(loads.begin(), loads.end());
  acting_.clear();
  next_.clear();
  std::fill(first_.begin(), first_.end(), -1);
  for (const PointLoad& load : loads) {
    const Pulls pulls = shape.pulls(load.s, base_rotation.transpose() * load.force);
    for (int i = 0; i < pulls.count; ++i) {
      const Pull& pull = pulls.pull[static_cast<std::size_t>(i)];
      if (pull.at.element < 0) continue;
      int& first = first_[static_cast<std::size_t>(pull.at.element)];
      next_.push_back(first);
      first = static_cast<int>(acting_.size());
      acting_.push_back(pull);
    }
  }
  Resultant beyond;
  for (int e = elements_ - 1; e >= 0; --e) {
    Vec3 work = shape.shift(e).transpose() * beyond.force + shape.spin(e).transpose() * beyond.moment();
    for (int i = first_[static_cast<std::size_t>(e)]; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
      const Pull& pull = acting_[static_cast<std::size_t>(i)];
      work.noalias() += pull.jacobian.transpose() * pull.force;
      beyond.add(pull);
    }
    work_[static_cast<std::size_t>(e)] = work;
  }
}

double BeamTangent::largest_imbalance(const BeamShape& shape, const Mat3& base_rotation,
                                      std::span<const PointLoad> loads) {
  reserve(static_cast<Eigen::Index>(loads.size()));
  sum_work(shape, base_rotation, loads);
  double largest = 0.0;
  for (int e = 0; e < elements_; ++e) {
    const Vec3 moment = shape.elastic_weight(e) * shape.stiffness().cwiseProduct(shape.moment_strain(e)) -
                        work_[static_cast<std::size_t>(e)] / shape.element_length();
    largest = larger_or_nan(largest, moment.norm());
  }
  return largest;
}

bool BeamTangent::relax(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                        Eigen::Ref<VecX> free) {
  if (!factorised_ || loads.size() > last_moved_.size()) return false;
  keep_first(loads.size());
  sum_work(shape, base_rotation, loads);
  for (int e = 0; e < elements_; ++e) {
    const Vec3& scale = scale_[static_cast<std::size_t>(e)];
    g_.segment<3>(row(e)) =
        shape.moment_strain(e).cwiseQuotient(scale) - scale.cwiseProduct(work_[static_cast<std::size_t>(e)]);
  }
  for (std::size_t c = 0; c < loads.size(); ++c) force_.segment<3>(3 * static_cast<Eigen::Index>(c)) = loads[c].force;
  z_ = g_;
  solve_lower(L_, 0, z_);
  move_loads(free);
  return true;
}

void BeamTangent::keep_first(std::size_t loads) {
  last_moved_.resize(loads);
  last_pull_.resize(loads);
  pulls_.resize(loads == 0 ? 0 : static_cast<std::size_t>(last_pull_.back()));
}

/// Another load, after those there.
void BeamTangent::locate(const BeamShape& shape, const Mat3& base_rotation, const PointLoad& load) {
  force_.segment<3>(3 * load_count()) = load.force;
  const Pulls pulls = shape.pulls(load.s, base_rotation.transpose() * load.force);
  int last_moved = -1;
  for (int i = 0; i < pulls.count; ++i) {
    pulls_.push_back(pulls.pull[static_cast<std::size_t>(i)]);
    last_moved = std::max(last_moved, pulls_.back().at.element);
  }
  last_pull_.push_back(static_cast<int>(pulls_.size()));
  last_moved_.push_back(last_moved);
}

bool BeamTangent::append(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                         Eigen::Ref<MatX> compliance) {
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  if (!factorised_ || loads.size() > last_moved_.size() + 1 || size > Y_.cols()) return false;
  keep_first(loads.size() - 1);
  locate(shape, base_rotation, loads.back());
  const Eigen::Index c = load_count() - 1;
  assemble_jacobian(base_rotation, c);
  auto column = Y_.middleCols<3>(3 * c);
  const Eigen::Index first = start(c, c + 1);
  solve_lower(L_, first, column);
  const Eigen::Index reach = Y_.rows() - first;
  compliance.noalias() = column.bottomRows(reach).transpose().lazyProduct(Y_.leftCols(size).bottomRows(reach));
  return true;
}

void BeamTangent::assemble_energy(const BeamShape& shape) {
  const double l = shape.element_length();
  Resultant beyond;
  for (int e = elements_ - 1; e >= 0; --e) {
    const auto scale = scale_[static_cast<std::size_t>(e)].asDiagonal();
    const Eigen::Index i = row(e);
    const Mat3 Rt = shape.frame(e).transpose();
    const Mat3 spin = shape.spin(e) * scale;
    const Mat3 shift = shape.shift(e) * scale;
    spin_.middleRows<3>(i) = spin.transpose();
    shift_.middleRows<3>(i) = shift.transpose();

    // Loads beyond the element: its end moves by its chord, and all beyond turns with its end frame.
    const RotationTerms terms = shape.terms({e, l});
    const Vec3 force = Rt * beyond.force;
    const Mat3 turning =
        Rt * (beyond.tensor.transpose() - beyond.force * shape.origin(e + 1).transpose()) * shape.frame(e + 1);
    Mat3 second = l * l * (l * terms.chord_hessian(force) + terms.rotation_hessian(turning));
    Vec3 generalised = shift.transpose() * beyond.force + spin.transpose() * beyond.moment();
    Mat3 lever = cross(beyond.force) * shift - beyond.double_cross() * spin;

    for (const Pull& pull : pulls_) {
      if (pull.at.element != e) continue;
      const double s = pull.at.local;
      const RotationTerms inner = shape.terms(pull.at);
      const Mat3 jacobian = pull.jacobian * scale;
      second += s * s * s * inner.chord_hessian(Rt * pull.force);
      generalised.noalias() += jacobian.transpose() * pull.force;
      lever.noalias() += cross(pull.force) * jacobian;
      beyond.add(pull);
    }

    g_.segment<3>(i) = shape.moment_strain(e).cwiseQuotient(scale_[static_cast<std::size_t>(e)]) - generalised;
    H_.block<3, 3>(i, i) = (1.0 + shape.damping) * Mat3::Identity() - scale * second * scale;
    lever_[e] = lever;
  }
  // An element a nearer the base turns the whole lever of element e: ∂²Π/∂y_a∂y_e = Ω_aᵀ Σ_c [f_c]× ∂r_c/∂y_e.
  for (int e = elements_ - 1; e >= 1; --e) {
    const Eigen::Index i = row(e) + 3;
    H_.block(i, i - 3, H_.rows() - i, 3).noalias() = spin_.bottomRows(H_.rows() - i).lazyProduct(lever_[e]);
  }
}

bool BeamTangent::factorise_shifted(Indefinite otherwise) {
  const auto attempt = [this](double shift) {
    L_.triangularView<Eigen::Lower>() = H_;
    L_.diagonal().array() += shift;
    elastic_shift_ = shift;
    return dense::factorise(L_);
  };
  if (attempt(0.0)) return true;
  if (otherwise == Indefinite::give_up) return false;
  // Beyond buckling. The first shift that works bounds the smallest eigenvalue; twice that shift leaves a margin.
  for (double shift = kSmallestShift; shift < 1e12; shift *= 2.0) {
    if (attempt(shift) && attempt(2.0 * shift)) return true;
  }
  // Only reached when loads or shape are not finite.
  L_.setIdentity();
  return true;
}

void BeamTangent::assemble_jacobian(const Mat3& base_rotation, Eigen::Index load) {
  const Mat3 to_base = base_rotation.transpose();
  const Eigen::Index rows = Y_.rows();
  auto column = Y_.middleCols<3>(3 * load);
  column.setZero();
  const auto c = static_cast<std::size_t>(load);
  for (int p = load == 0 ? 0 : last_pull_[c - 1]; p < last_pull_[c]; ++p) {
    const Pull& pull = pulls_[static_cast<std::size_t>(p)];
    if (pull.at.element < 0) continue;
    const Eigen::Index i = row(pull.at.element);
    const Eigen::Index below = rows - i - 3;
    const Mat3 shifted = pull.weight * to_base;
    const Mat3 turned = pull.weight * cross(pull.point) * to_base;
    column.middleRows<3>(i).noalias() +=
        scale_[static_cast<std::size_t>(pull.at.element)].asDiagonal() * (pull.jacobian.transpose() * shifted);
    column.bottomRows(below).noalias() += shift_.bottomRows(below).lazyProduct(shifted);
    column.bottomRows(below).noalias() += spin_.bottomRows(below).lazyProduct(turned);
  }
}

void BeamTangent::add_springs(std::span<const Mat3> springs) {
  assert(springs.size() == last_moved_.size());
  for (std::size_t c = 0; c < last_moved_.size(); ++c) {
    const int e = last_moved_[c];
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

/// For the columns of some loads at a time: first of them, how many, and how many of the last rows are not zero.
template <class Function>
void BeamTangent::for_groups(Function&& function) const {
  for (Eigen::Index c = 0; c < load_count(); c += kCondensed) {
    const Eigen::Index last = std::min(load_count(), c + kCondensed);
    function(3 * c, 3 * (last - c), Y_.rows() - start(c, last));
  }
}

Eigen::Index BeamTangent::start(Eigen::Index first_load, Eigen::Index last_load) const {
  Eigen::Index first_row = Y_.rows();
  for (Eigen::Index c = first_load; c < last_load; ++c) {
    const int e = last_moved_[static_cast<std::size_t>(c)];
    if (e >= 0) first_row = std::min(first_row, row(e));
  }
  return first_row;
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
  assert(loads.size() == last_moved_.size());
  for (std::size_t c = 0; c < loads.size(); ++c) {
    const auto i = 3 * static_cast<Eigen::Index>(c);
    less_.segment<3>(i) = force_.segment<3>(i) - loads[c].force;
  }
  step_ = -z_;
  for_groups([&](Eigen::Index first, Eigen::Index count, Eigen::Index reach) {
    dense::subtract_product(step_.tail(reach), Y_.block(Y_.rows() - reach, first, reach, count),
                            less_.segment(first, count));
  });
  solve_upper(L_, step_);
  for (int e = 0; e < elements_; ++e)
    shape.curvature.segment<3>(dof(e)) += scale_[static_cast<std::size_t>(e)].cwiseProduct(step_.segment<3>(row(e)));
}

VecX BeamTangent::gradient() const {
  VecX gradient(g_.size());
  for (int e = 0; e < elements_; ++e)
    gradient.segment<3>(dof(e)) = g_.segment<3>(row(e)).cwiseQuotient(scale_[static_cast<std::size_t>(e)]);
  return gradient;
}

MatX BeamTangent::hessian() const {
  const MatX full = H_.selfadjointView<Eigen::Lower>();
  MatX hessian(full.rows(), full.cols());
  for (int a = 0; a < elements_; ++a) {
    for (int b = 0; b < elements_; ++b) {
      hessian.block<3, 3>(dof(a), dof(b)) = scale_[static_cast<std::size_t>(a)].cwiseInverse().asDiagonal() *
                                            full.block<3, 3>(row(a), row(b)) *
                                            scale_[static_cast<std::size_t>(b)].cwiseInverse().asDiagonal();
    }
  }
  return hessian;
}

}  // namespace stylet::beam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_grips.hpp"

#include <algorithm>

namespace stylet {

namespace {
/// Errors at contacts at rest that move less force than this part of the allowed error are left. Raised, fewer of them
/// are solved for; what is left looks like slow convergence, so that tangents are made anew.
constexpr double kNegligible = 0.1;
}  // namespace

RestingGrips::RestingGrips(const ContactRows& rows, int grips, int most_others)
    : rows_(rows), matrix_(grips), sliding_(grips), held_(grips, most_others) {
  const Eigen::Index most = RestingMatrix::most_rows(grips);
  const Eigen::Index others = 3 * static_cast<Eigen::Index>(most_others);
  if (grips > 0) compliance_ = MatX::Zero(dense::column_length(others), others);
  moved_ = VecX::Zero(others);
  columns_ = MatX::Zero(std::max(most, others), GripMatrix::kMostColumns);
  z_ = given_ = still_ = drift_ = VecX::Zero(most);
}

Yield RestingGrips::yield(int grip) const {
  Yield yield = matrix_.yield(grip);
  yield.axial += sliding_.more(grip);
  return yield;
}

bool RestingGrips::follow() {
  if (!matrix_.fits()) return false;
  switch (sliding_.follow(yields(), matrix_)) {
    case SlidingRows::Change::none:
      return true;
    case SlidingRows::Change::some:
      held_.follow(matrix_, sliding_);
      ++version_;
      return true;
    default:
      matrix_.outdate();
      return false;
  }
}

bool RestingGrips::fit(const MatX& A, const NeedleSide& side) {
  if (!are_any()) return true;
  if (!follow()) {
    const Eigen::Index n = matrix_.contact_rows();
    const auto springs = side.shaft_springs();
    const auto lent = springs.empty() ? springs : springs.first(static_cast<std::size_t>(count()));
    sliding_.clear();
    held_.clear();
    moves_ = false;
    tip_is_new_ = true;
    drift_.setZero();
    ++version_;
    if (!matrix_.factorise(A.block(3, 3, n, n), side.N.block(3, 3, n, n), lent, yields()) || !follow()) return false;
  }
  take_contacts(A, side);
  return true;
}

void RestingGrips::take_contacts(const MatX& A, const NeedleSide& side) {
  if (!are_any()) return;
  const Eigen::Index rest = matrix_.contact_rows();
  for (int other = held_.known(); other + count() < side.count; ++other)
    held_.add(A.block(3, 3 * (other + count()), rest, 3), matrix_, sliding_);
  const Eigen::Index n = held_.others() - 3;
  compliance_.topLeftCorner(3 + n, 3 + n) = -held_.reduction();
  compliance_.block(3, 3, n, n) += A.block(first_own(), first_own(), n, n);
  add_tip_of(A);
}

/// Adds the tip's columns of A to those of the others' compliance.
void RestingGrips::add_tip_of(const MatX& A) {
  const Eigen::Index n = held_.others() - 3;
  compliance_.topLeftCorner<3, 3>() += A.topLeftCorner<3, 3>();
  compliance_.block(3, 0, n, 3) += A.block(first_own(), 0, n, 3);
}

/// Writes the right-hand side to z_. @return whether it has to be solved for; if not, still_ is up to date
bool RestingGrips::right_side(const NeedleSide& side) {
  auto z = z_.head(matrix_.rows());
  for (int c = 1; c <= count(); ++c)
    z.segment<3>(3 * c - 3).noalias() = -(rows_.frame[static_cast<std::size_t>(c)] * rows_.error(c));
  matrix_.fill_springs(z);
  z.head(matrix_.contact_rows()) += side.free.segment(3, matrix_.contact_rows());

  const double negligible_N = solves_all_ ? 0.0 : kNegligible * rows_.allowed();
  if (matrix_.is_negligible(z, negligible_N)) {
    moves_ = false;
    return false;
  }
  if (moves_) {
    auto change = columns_.col(0).head(matrix_.rows());
    change = z - given_.head(matrix_.rows());
    if (matrix_.is_negligible(change, negligible_N)) return false;
  }
  given_.head(matrix_.rows()) = z;
  return true;
}

void RestingGrips::solve(const MatX& A, const NeedleSide& side) {
  const Eigen::Index rows = matrix_.rows();
  const bool anew = right_side(side);
  // All columns in one pass over the factor: the tip's, the right-hand side and the drift.
  Eigen::Index count = 0;
  if (tip_is_new_) {
    columns_.topLeftCorner(rows, 3) = held_.begin_tip(A.block(3, 0, matrix_.contact_rows(), 3), matrix_);
    count = 3;
  }
  if (anew) columns_.col(count++).head(rows) = z_.head(rows);
  const bool drifts = rows_.tip.drifts() && count > 0;
  if (drifts) {
    auto column = columns_.col(count++).head(rows);
    column.head(matrix_.contact_rows()) = rows_.tip.drift.segment(3, matrix_.contact_rows());
    matrix_.fill_springs(column);
  }
  if (count > 0) matrix_.solve(columns_.topLeftCorner(rows, count));
  if (drifts) drift_.head(rows) = columns_.col(--count).head(rows);
  if (anew) {
    still_.head(rows) = columns_.col(--count).head(rows);
    moves_ = true;
  }
  if (tip_is_new_) {
    held_.set_tip(columns_.topLeftCorner(rows, 3), matrix_, sliding_);
    compliance_.topLeftCorner(held_.others(), 3) = -held_.reduction().leftCols(3);
    add_tip_of(A);
    tip_is_new_ = false;
  }
  auto moved = moved_.head(held_.others());
  if (moves_) {
    held_.motion(still_.head(rows), matrix_, sliding_, moved);
  } else {
    moved.setZero();
  }
}

// NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views

void RestingGrips::correct_drift(Eigen::Ref<VecX> drift) {
  auto motion = columns_.col(0).head(held_.others());
  held_.motion(drift_.head(matrix_.rows()), matrix_, sliding_, motion);
  drift -= motion;
}

void RestingGrips::finish(const Eigen::Ref<const VecX>& others, double cut, VecX& push, Eigen::Ref<VecX> force) {
  const Eigen::Index n = matrix_.contact_rows();
  auto z = z_.head(matrix_.rows());
  if (moves_) {
    z = still_.head(matrix_.rows());
  } else {
    z.setZero();
  }
  if (cut != 0.0) z -= cut * drift_.head(matrix_.rows());
  held_.subtract(others, z);
  sliding_.yield_in(z, matrix_);
  push.segment(3, n) = rows_.now.segment(3, n) + z.head(n);
  auto change = columns_.col(0).head(n);
  matrix_.forces(z, change);
  force.segment(3, n) = rows_.now.segment(3, n) + change;
}

void RestingGrips::settle(VecX& push, Eigen::Ref<VecX> force) {
  const Eigen::Index n = matrix_.contact_rows();
  auto z = z_.head(matrix_.rows());
  if (moves_) {
    z = still_.head(matrix_.rows());
    sliding_.yield_in(z, matrix_);
  } else {
    z.setZero();
  }
  push.segment(3, n) = rows_.now.segment(3, n) + z.head(n);
  auto change = columns_.col(0).head(n);
  matrix_.forces(z, change);
  force.segment(3, n) = rows_.now.segment(3, n) + change;
}

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/sliding_rows.hpp"

#include "core/dense_lu.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// A change of D along the needle below this part of the contact's compliance is ignored; it adds to the error of the
/// next iteration. Raised, fewer contacts are treated as sliding, and iterations converge more slowly.
constexpr double kSameAlong = 1e-3;
}  // namespace

SlidingRows::SlidingRows(int grips)
    : known_(static_cast<std::size_t>(grips)),
      columns_(MatX::Zero(RestingMatrix::most_rows(grips), grips)),
      factors_(MatX::Zero(grips, grips)),
      pivots_(static_cast<std::size_t>(grips)),
      slips_(VecX::Zero(grips)) {
  sliding_.reserve(static_cast<std::size_t>(grips));
}

void SlidingRows::clear() {
  sliding_.clear();
  std::fill(known_.begin(), known_.end(), Column{});
}

double SlidingRows::more(int grip) const {
  for (const Sliding& sliding : sliding_) {
    if (sliding.grip == grip) return sliding.more;
  }
  return 0.0;
}

/// Whether the j-th sliding contact is this one, with the same yield.
bool SlidingRows::is_as(std::size_t j, int grip, double more) const {
  return j < sliding_.size() && sliding_[j].grip == grip &&
         std::abs(sliding_[j].more - more) <= kSameAlong * std::abs(more);
}

bool SlidingRows::differs(std::span<const Yield> yields, const RestingMatrix& matrix) const {
  std::size_t same = 0;
  for (int g = 0; g < matrix.count(); ++g) {
    const Yield& now = yields[static_cast<std::size_t>(g)];
    if (matrix.is_too_different(g, now)) return true;
    const double more = now.axial - matrix.yield(g).axial;
    if (std::abs(more) <= kSameAlong * matrix.compliance(g)) continue;
    if (!is_as(same, g, more)) return true;
    ++same;
  }
  return same != sliding_.size();
}

SlidingRows::Change SlidingRows::follow(std::span<const Yield> yields, RestingMatrix& matrix) {
  std::size_t same = 0;  // sliding contacts from the first on that are as they were
  bool differs = false;
  for (int g = 0; g < matrix.count(); ++g) {
    const Yield& now = yields[static_cast<std::size_t>(g)];
    if (matrix.is_too_different(g, now)) return Change::needs_new_matrix;
    const double more = now.axial - matrix.yield(g).axial;
    if (std::abs(more) <= kSameAlong * matrix.compliance(g)) continue;
    differs = differs || !is_as(same, g, more);
    if (differs) {
      sliding_.resize(same);
      sliding_.push_back({g, more});
    }
    ++same;
  }
  if (!differs && same == sliding_.size()) return Change::none;
  sliding_.resize(same);

  for (const Sliding& sliding : sliding_) know(sliding.grip, matrix);
  for (Eigen::Index j = 0; j < count(); ++j) {
    const Sliding& one = sliding_[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < count(); ++i)
      factors_(i, j) = along(columns_.col(one.grip), sliding_[static_cast<std::size_t>(i)].grip, matrix);
    factors_(j, j) += 1.0 / one.more;
  }
  if (count() > 0 && !dense::factorise_lu(factors_.topLeftCorner(count(), count()), std::span(pivots_).first(same)))
    return Change::needs_new_matrix;
  return Change::some;
}

void SlidingRows::solve_column(int grip, RestingMatrix& matrix) {
  auto column = columns_.col(grip).head(matrix.rows());
  column.setZero();
  column.segment<3>(3 * grip) = matrix.yield(grip).along;
  matrix.fill_springs(column);
  Column& known = known_[static_cast<std::size_t>(grip)];
  known = {.known = true};
  for (Eigen::Index row = matrix.contact_rows(); row < matrix.rows(); row += 2) {
    if (column.segment<2>(row).isZero(0.0)) continue;
    known.row = row;
    known.along = column.segment<2>(row);
  }
  matrix.solve(columns_.block(0, grip, matrix.rows(), 1));
}

/// eᵀ z
double SlidingRows::along(const Eigen::Ref<const VecX>& z, int grip, const RestingMatrix& matrix) const {
  const Column& column = known_[static_cast<std::size_t>(grip)];
  const double push = matrix.yield(grip).along.dot(z.segment<3>(3 * grip));
  return column.row < 0 ? push : push + column.along.dot(z.segment<2>(column.row));
}

// NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views

void SlidingRows::take(const Eigen::Ref<const MatX>& columns, const RestingMatrix& matrix, Eigen::Ref<MatX> of) const {
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    for (Eigen::Index j = 0; j < count(); ++j)
      of(j, k) = along(columns.col(k), sliding_[static_cast<std::size_t>(j)].grip, matrix);
  }
}

void SlidingRows::divide(Eigen::Ref<MatX> Y) const {
  if (count() > 0)
    dense::solve_lu(factors_.topLeftCorner(count(), count()), std::span(pivots_).first(sliding_.size()), Y);
}

Eigen::Ref<const VecX> SlidingRows::slips(const Eigen::Ref<const VecX>& z, const RestingMatrix& matrix) {
  auto slips = slips_.head(count());
  take(z, matrix, slips);
  divide(slips);
  return slips;
}

void SlidingRows::yield_in(Eigen::Ref<VecX> z, const RestingMatrix& matrix) {
  const auto by = slips(z, matrix);
  for (Eigen::Index j = 0; j < count(); ++j)
    z -= by[j] * columns_.col(sliding_[static_cast<std::size_t>(j)].grip).head(matrix.rows());
}

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/yielding_rows.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"
#include "core/dense_lu.hpp"

#include <algorithm>
#include <cassert>

namespace stylet {

YieldingRows::YieldingRows(Eigen::Index most_rows, Eigen::Index most_spring_rows, Eigen::Index most_columns)
    : contacts_(MatX::Zero(dense::column_length(most_rows), most_rows)),
      by_springs_(MatX::Zero(most_rows, most_spring_rows)),
      springs_(MatX::Zero(most_spring_rows, most_spring_rows)),
      pivots_(static_cast<std::size_t>(most_spring_rows)),
      work_(MatX::Zero(most_spring_rows, most_columns)) {
  yield_.reserve(static_cast<std::size_t>(most_rows));
  directions_.reserve(static_cast<std::size_t>(3 * most_spring_rows / 2));
}

void YieldingRows::begin(Eigen::Index spring_rows) {
  yield_.clear();
  spring_rows_ = spring_rows;
  directions_.clear();
  factorised_ = false;
  unchanged_columns_ = 0;
}

void YieldingRows::add_row(double yield) {
  yield_.push_back(yield);
  factorised_ = false;
  unchanged_columns_ = 0;
}

void YieldingRows::add_direction(Eigen::Index row, Eigen::Index spring_row, const Eigen::RowVector2d& components) {
  directions_.push_back({row, spring_row, components});
  factorised_ = false;
}

void YieldingRows::keep_first(Eigen::Index count) {
  assert(count <= rows());
  factorised_ = factorised_ && count == rows();
  if (!factorised_) unchanged_columns_ = 0;
  yield_.resize(static_cast<std::size_t>(count));
}

void YieldingRows::set_yield(Eigen::Index row, double yield) {
  yield_[static_cast<std::size_t>(row)] = yield;
  factorised_ = false;
  unchanged_columns_ = std::min(unchanged_columns_, row);
}

bool YieldingRows::factorise(const Eigen::Ref<const MatX>& R) {
  assert(R.rows() == spring_rows_ + rows() && R.cols() == R.rows());
  factorised_ = factorise_contacts(R) && (spring_rows_ == 0 || factorise_springs(R));
  return factorised_;
}

bool YieldingRows::factorise_contacts(const Eigen::Ref<const MatX>& R) {
  const Eigen::Index c = rows();
  const Eigen::Index s = spring_rows_;
  auto L = contacts_.topLeftCorner(c, c);
  const Eigen::Index from = unchanged_columns_ / dense::kTile * dense::kTile;
  unchanged_columns_ = 0;
  for (Eigen::Index j = from; j < c; ++j) {
    L.col(j).tail(c - j) = R.col(s + j).tail(c - j);
    L(j, j) += yield_[static_cast<std::size_t>(j)];
  }
  if (!dense::factorise_from(L, from)) return false;
  unchanged_columns_ = c;
  return true;
}

bool YieldingRows::factorise_springs(const Eigen::Ref<const MatX>& R) {
  const Eigen::Index c = rows();
  const Eigen::Index s = spring_rows_;
  const auto weighted = [this](const Direction& direction) -> Eigen::RowVector2d {
    return yield_[static_cast<std::size_t>(direction.row)] * direction.components;
  };
  auto across = by_springs_.topLeftCorner(c, s);
  across = R.bottomLeftCorner(c, s);
  for (const Direction& direction : directions_)
    across.block<1, 2>(direction.row, direction.spring_row) += weighted(direction);
  dense::solve_lower(contacts_.topLeftCorner(c, c), 0, across);
  auto left = springs_.topLeftCorner(s, s);
  dense::transposed_product(left, across, across);
  for (Eigen::Index j = 0; j < s; ++j) {
    for (Eigen::Index i = 0; i < s; ++i) left(i, j) = R(std::max(i, j), std::min(i, j)) - left(i, j);
  }
  for (const Direction& direction : directions_)
    left.block<2, 2>(direction.spring_row, direction.spring_row).noalias() +=
        direction.components.transpose() * weighted(direction);
  return dense::factorise_lu(left, pivots_);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): Y is written through the view
void YieldingRows::solve(Eigen::Ref<MatX> Y) {
  assert(factorised_);
  const Eigen::Index c = rows();
  const Eigen::Index s = spring_rows_;
  const auto L = contacts_.topLeftCorner(c, c);
  auto of_springs = Y.topRows(s);
  auto of_contacts = Y.bottomRows(c);
  dense::solve_lower(L, 0, of_contacts);
  if (s > 0) {
    const auto across = by_springs_.topLeftCorner(c, s);
    auto known = work_.topLeftCorner(s, Y.cols());
    dense::transposed_product(known, across, of_contacts);
    of_springs -= known;
    dense::solve_lu(springs_.topLeftCorner(s, s), pivots_, of_springs);
    dense::subtract_product(of_contacts, across, of_springs);
  }
  dense::solve_upper(L, of_contacts);
}

}  // namespace stylet

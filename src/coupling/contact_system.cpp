// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_system.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_lu.hpp"

namespace stylet {

ContactSystem::ContactSystem(int contacts) {
  const Eigen::Index n = 3 * contacts;
  A = N = matrix_ = work_ = MatX::Zero(n, n);
  gap = free = now = spring = D = shift = lambda = p = needle_ = preload_ = right_ = VecX::Zero(n);
  rows.reserve(static_cast<std::size_t>(n));
}

void ContactSystem::begin(Eigen::Index size) {
  size_ = size;
  auto pushed = preload_.head(size);
  pushed.noalias() = N.topLeftCorner(size, size).lazyProduct(now.head(size));
  needle_.head(size) = gap.head(size) + pushed;
  if (supported) {
    pushed = spring.head(size).cwiseProduct(free.head(size) + pushed);
  } else {
    pushed.setZero();
  }
}

bool ContactSystem::solve() {
  const auto held = static_cast<Eigen::Index>(rows.size());
  lambda.head(size_).setZero();
  p.head(size_).setZero();
  if (held == 0) return true;
  return supported ? solve_supported(held) : solve_symmetric(held);
}

bool ContactSystem::solve_symmetric(Eigen::Index held) {
  for (Eigen::Index j = 0; j < held; ++j) {
    const int rj = rows[static_cast<std::size_t>(j)];
    for (Eigen::Index i = j; i < held; ++i) {
      const int ri = rows[static_cast<std::size_t>(i)];
      matrix_(i, j) = A(ri, rj) + N(ri, rj);
    }
    matrix_(j, j) += D[rj];
    right_[j] = needle_[rj] + shift[rj];
  }
  auto matrix = matrix_.topLeftCorner(held, held);
  auto right = right_.head(held);
  if (!dense::factorise(matrix)) return false;
  dense::solve_lower(matrix, 0, right);
  dense::solve_upper(matrix, right);
  for (Eigen::Index i = 0; i < held; ++i) lambda[rows[static_cast<std::size_t>(i)]] = right[i];
  p.head(size_) = lambda.head(size_);
  return true;
}

bool ContactSystem::solve_supported(Eigen::Index held) {
  // work = (A + D) G on the held rows, then matrix = A + D + N − work N.
  auto work = work_.topLeftCorner(held, held);
  auto matrix = matrix_.topLeftCorner(held, held);
  auto right = right_.head(held);
  for (Eigen::Index j = 0; j < held; ++j) {
    const int rj = rows[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < held; ++i) {
      const int ri = rows[static_cast<std::size_t>(i)];
      const double stiffness = a(ri, rj) + (i == j ? D[ri] : 0.0);
      work(i, j) = stiffness * spring[rj];
      matrix(i, j) = stiffness + N(ri, rj);
    }
  }
  for (Eigen::Index i = 0; i < held; ++i) {
    const int ri = rows[static_cast<std::size_t>(i)];
    right[i] = needle_[ri] + shift[ri];
  }
  for (Eigen::Index k = 0; k < held; ++k) {
    const int rk = rows[static_cast<std::size_t>(k)];
    if (spring[rk] == 0.0) continue;
    for (Eigen::Index j = 0; j < held; ++j) matrix.col(j) -= N(rk, rows[static_cast<std::size_t>(j)]) * work.col(k);
    right -= (preload_[rk] / spring[rk]) * work.col(k);
  }
  if (!dense::solve_unsymmetric(matrix, right)) return false;
  for (Eigen::Index i = 0; i < held; ++i) p[rows[static_cast<std::size_t>(i)]] = right[i];
  // λ = p + G (free − N (p − now)) = p + preload − G N p
  for (Eigen::Index i = 0; i < held; ++i) {
    const int ri = rows[static_cast<std::size_t>(i)];
    lambda[ri] = p[ri] + preload_[ri] - spring[ri] * N.row(ri).head(size_).dot(p.head(size_));
  }
  return true;
}

double ContactSystem::opening(int row) const {
  double value = needle_[row] - N.row(row).head(size_).dot(p.head(size_));
  for (const int r : rows) value -= a(row, r) * lambda[r];
  return value;
}

}  // namespace stylet

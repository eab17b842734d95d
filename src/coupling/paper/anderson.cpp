// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/paper/anderson.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace stylet::paper {

Anderson::Anderson(Eigen::Index size)
    : changes_(MatX::Zero(size, kDepth)),
      results_(MatX::Zero(size, kDepth)),
      change_(VecX::Zero(size)),
      result_(VecX::Zero(size)) {}

void Anderson::accelerate(const Eigen::Ref<const VecX>& x, Eigen::Ref<VecX> g) {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kDepth, kDepth>;
  using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kDepth, 1>;
  if (count_ > 0) {
    const int column = (count_ - 1) % kDepth;
    changes_.col(column) = g - x - change_;
    results_.col(column) = g - result_;
  }
  change_ = g - x;
  result_ = g;
  const int known = std::min(count_, kDepth);
  ++count_;
  if (known == 0) return;
  const auto differences = changes_.leftCols(known);
  Small normal(known, known);
  normal.noalias() = differences.transpose().lazyProduct(differences);
  Weights right(known);
  right.noalias() = differences.transpose().lazyProduct(change_);
  normal.diagonal() *= 1.0 + 1e-12;
  normal.diagonal().array() += 1e-300;
  const Weights weights = normal.ldlt().solve(right);
  if (!weights.allFinite()) {
    restart();
    return;
  }
  g.noalias() -= results_.leftCols(known).lazyProduct(weights);
}

}  // namespace stylet::paper

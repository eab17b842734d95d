// SPDX-License-Identifier: GPL-3.0-or-later
#include "cholesky.hpp"

#include "blas_threads.hpp"
#include "ordering.hpp"
#include "spd_inverse.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>
#include <vector>

namespace stylet::detail {
namespace {

// A pivot below this share of its diagonal entry means a motion without stiffness. Rigid motion leaves rounding, some
// 1e-16 … 1e-14 of the entry; a bar a thousand times longer than thick still leaves 1e-10.
constexpr double kTinyPivot = 1e-13;

// Number of right-hand sides solved together: enough for efficient matrix products, few enough to limit memory.
constexpr Eigen::Index kBatch = 192;

void quiet(cholmod_common& common) {
  cholmod_start(&common);
  common.print = 0;
  common.error_handler = nullptr;
}

// First column (in K's numbering) whose pivot is tiny compared with K's diagonal entry, or -1.
Index tiny_pivot(const Eigen::SparseMatrix<double>& K, const cholmod_factor& L) {
  const auto* super = static_cast<const int*>(L.super);
  const auto* begin_rows = static_cast<const int*>(L.pi);
  const auto* begin_values = static_cast<const int*>(L.px);
  const auto* values = static_cast<const double*>(L.x);
  const auto* permutation = static_cast<const int*>(L.Perm);
  const VecX diagonal = K.diagonal();
  for (size_t s = 0; s < L.nsuper; ++s) {
    const std::ptrdiff_t rows = begin_rows[s + 1] - begin_rows[s];
    for (int column = super[s]; column < super[s + 1]; ++column) {
      const std::ptrdiff_t j = column - super[s];
      const double pivot = values[begin_values[s] + j * rows + j];
      const Index original = permutation[column];
      if (!(pivot * pivot > kTinyPivot * diagonal[original])) return original;
    }
  }
  return -1;
}

}  // namespace

Cholesky::Cholesky() {
  quiet(common_);
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.final_ll = 1;
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_GIVEN;
  common_.postorder = 0;  // elimination_order() has already applied the postorder
}

Cholesky::~Cholesky() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_finish(&common_);
}

Cholesky::Failure Cholesky::factorise(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& nodes,
                                      std::span<const int> last, const Progress& progress) {
  const OneBlasThread one_thread;
  const auto failure = [this] {
    switch (common_.status) {
      case CHOLMOD_TOO_LARGE:
        return Failure::too_large;
      case CHOLMOD_OUT_OF_MEMORY:
        return Failure::out_of_memory;
      default:
        return Failure::refused;
    }
  };

  report(progress, "ordering", 0.0);
  const std::vector<int> node_order = elimination_order(nodes, last, common_);
  if (node_order.empty()) return failure();
  std::vector<int> order(3 * node_order.size());
  for (size_t i = 0; i < node_order.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) order[3 * i + axis] = 3 * node_order[i] + axis;
  }
  last_ = 3 * last.size();

  cholmod_sparse matrix = view(K, CHOLMOD_REAL);
  cholmod_free_factor(&factor_, &common_);  // left over from an attempt that failed
  factor_ = cholmod_analyze_p(&matrix, order.data(), nullptr, 0, &common_);
  if (factor_ == nullptr) return failure();

  report(progress, "factorising", 0.0);
  if (!cholmod_factorize(&matrix, factor_, &common_)) return failure();
  if (common_.status == CHOLMOD_NOT_POSDEF || factor_->minor < factor_->n) {
    failed_column_ = static_cast<const int*>(factor_->Perm)[factor_->minor];
    return Failure::not_positive_definite;
  }
  failed_column_ = tiny_pivot(K, *factor_);
  if (failed_column_ >= 0) return Failure::not_positive_definite;
  report(progress, "factorising", 1.0);
  return Failure::none;
}

MatX Cholesky::solve(const MatX& b) const {
  const OneBlasThread one_thread;
  // Each call has its own workspace, so the factor is only read.
  struct Workspace {
    cholmod_common common{};
    cholmod_dense* X = nullptr;
    cholmod_dense* Y = nullptr;
    cholmod_dense* E = nullptr;
    Workspace() { quiet(common); }
    ~Workspace() {
      cholmod_free_dense(&X, &common);
      cholmod_free_dense(&Y, &common);
      cholmod_free_dense(&E, &common);
      cholmod_finish(&common);
    }
  } work;

  MatX x(b.rows(), b.cols());
  for (Eigen::Index first = 0; first < b.cols(); first += kBatch) {
    const Eigen::Index count = std::min(kBatch, b.cols() - first);
    cholmod_dense B{};
    B.nrow = static_cast<size_t>(b.rows());
    B.ncol = static_cast<size_t>(count);
    B.d = B.nrow;
    B.nzmax = B.nrow * B.ncol;
    B.x = const_cast<double*>(b.data() + first * b.rows());
    B.xtype = CHOLMOD_REAL;
    B.dtype = CHOLMOD_DOUBLE;
    if (!cholmod_solve2(CHOLMOD_A, factor_, &B, nullptr, &work.X, nullptr, &work.Y, &work.E, &work.common)) {
      throw std::bad_alloc();
    }
    x.middleCols(first, count) = Eigen::Map<const MatX>(static_cast<const double*>(work.X->x), b.rows(), count);
  }
  return x;
}

MatX Cholesky::inverse_of_last(const Progress& progress) const {
  const auto size = static_cast<Eigen::Index>(last_);
  const auto first = static_cast<int>(factor_->n - last_);
  MatX block = MatX::Zero(size, size);
  const auto* super = static_cast<const int*>(factor_->super);
  const auto* begin_rows = static_cast<const int*>(factor_->pi);
  const auto* begin_values = static_cast<const int*>(factor_->px);
  const auto* rows = static_cast<const int*>(factor_->s);
  const auto* values = static_cast<const double*>(factor_->x);
  for (size_t s = 0; s < factor_->nsuper; ++s) {
    const std::ptrdiff_t height = begin_rows[s + 1] - begin_rows[s];
    for (int column = std::max(first, super[s]); column < super[s + 1]; ++column) {
      const std::ptrdiff_t j = column - super[s];
      const double* below = values + begin_values[s] + j * height;
      for (std::ptrdiff_t i = j; i < height; ++i) block(rows[begin_rows[s] + i] - first, column - first) = below[i];
    }
  }
  return inverse_from_factor(std::move(block), progress);
}

double Cholesky::megabytes() const {
  if (factor_ == nullptr) return 0.0;
  const double bytes = 8.0 * static_cast<double>(factor_->xsize) + 4.0 * static_cast<double>(factor_->ssize) +
                       4.0 * static_cast<double>(3 * factor_->nsuper + 2 * factor_->n);
  return bytes / 1048576.0;
}

Index Cholesky::entries() const { return factor_ == nullptr ? 0 : static_cast<Index>(factor_->xsize); }

}  // namespace stylet::detail

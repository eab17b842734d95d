// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/paper/inverse_updates.hpp"

#include "fem/blas_threads.hpp"

#include <cblas.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dpotri_(const char* uplo, const int* n, double* a, const int* lda, int* info);
}

namespace stylet::paper {

namespace {

double size_of(double x) { return std::abs(x); }
double size_of(Counted x) { return std::abs(x.value); }

/// M −= left rightᵀ.
template <class Scalar>
void subtract_rank_one(MatrixRef<Scalar> M, std::span<const Scalar> left, std::span<const Scalar> right) {
  for (Eigen::Index j = 0; j < M.cols(); ++j)
    for (Eigen::Index i = 0; i < M.rows(); ++i)
      M(i, j) -= left[static_cast<std::size_t>(i)] * right[static_cast<std::size_t>(j)];
}
template <>
void subtract_rank_one<double>(MatrixRef<double> M, std::span<const double> left, std::span<const double> right) {
  cblas_dger(CblasColMajor, static_cast<int>(M.rows()), static_cast<int>(M.cols()), -1.0, left.data(), 1, right.data(),
             1, M.data(), static_cast<int>(M.outerStride()));
}

/// A B.
template <class Scalar>
Matrix<Scalar> product(const Matrix<Scalar>& A, const Matrix<Scalar>& B) {
  Matrix<Scalar> C(A.rows(), B.cols());
  for (Eigen::Index j = 0; j < B.cols(); ++j) {
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      Scalar sum = 0.0;
      for (Eigen::Index k = 0; k < A.cols(); ++k) sum += A(i, k) * B(k, j);
      C(i, j) = sum;
    }
  }
  return C;
}
template <>
Matrix<double> product<double>(const Matrix<double>& A, const Matrix<double>& B) {
  return A * B;
}

/// C −= A Bᵀ.
template <class Scalar>
void subtract_product(MatrixRef<Scalar> C, const Matrix<Scalar>& A, const Matrix<Scalar>& B) {
  for (Eigen::Index k = 0; k < A.cols(); ++k)
    for (Eigen::Index j = 0; j < C.cols(); ++j)
      for (Eigen::Index i = 0; i < C.rows(); ++i) C(i, j) -= A(i, k) * B(j, k);
}

void blas_subtract_product(double* C, int stride, int rows, int columns, const double* A, int a_stride, const double* B,
                           int b_stride, int inner) {
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, inner, -1.0, A, a_stride, B, b_stride, 1.0, C,
              stride);
}
template <>
void subtract_product<double>(MatrixRef<double> C, const Matrix<double>& A, const Matrix<double>& B) {
  blas_subtract_product(C.data(), static_cast<int>(C.outerStride()), static_cast<int>(C.rows()),
                        static_cast<int>(C.cols()), A.data(), static_cast<int>(A.outerStride()), B.data(),
                        static_cast<int>(B.outerStride()), static_cast<int>(A.cols()));
}

/// Inverse by Gauss–Jordan elimination with row exchanges: k³ multiplications. @return false when the matrix is
/// singular
template <class Scalar>
bool eliminate(Matrix<Scalar>& A) {
  const Eigen::Index k = A.rows();
  std::vector<Eigen::Index> exchanged(static_cast<std::size_t>(k));
  for (Eigen::Index p = 0; p < k; ++p) {
    Eigen::Index best = p;
    for (Eigen::Index i = p + 1; i < k; ++i)
      if (size_of(A(i, p)) > size_of(A(best, p))) best = i;
    if (!(size_of(A(best, p)) > 0.0) || !std::isfinite(size_of(A(best, p)))) return false;
    exchanged[static_cast<std::size_t>(p)] = best;
    if (best != p)
      for (Eigen::Index j = 0; j < k; ++j) std::swap(A(p, j), A(best, j));
    const Scalar pivot = Scalar(1.0) / A(p, p);
    A(p, p) = 1.0;
    for (Eigen::Index j = 0; j < k; ++j) A(p, j) *= pivot;
    for (Eigen::Index i = 0; i < k; ++i) {
      if (i == p) continue;
      const Scalar factor = A(i, p);
      A(i, p) = 0.0;
      for (Eigen::Index j = 0; j < k; ++j) A(i, j) -= factor * A(p, j);
    }
  }
  for (Eigen::Index p = k - 1; p >= 0; --p) {
    const Eigen::Index best = exchanged[static_cast<std::size_t>(p)];
    if (best != p)
      for (Eigen::Index i = 0; i < k; ++i) std::swap(A(i, p), A(i, best));
  }
  return true;
}

template <class Scalar>
double one_norm(const Matrix<Scalar>& A) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < A.rows(); ++i) sum += size_of(A(i, j));
    largest = std::max(largest, sum);
  }
  return largest;
}

/// The terms of the lemma that do not depend on how the large matrix is written back.
template <class Scalar>
struct Correction {
  Matrix<Scalar> columns;  ///< K⁻¹V (N × k)
  Matrix<Scalar> small;    ///< ΔK (I + VᵀK⁻¹V ΔK)⁻¹ (k × k)
  double condition = std::numeric_limits<double>::infinity();
};

template <class Scalar>
Correction<Scalar> correction(const Matrix<Scalar>& columns, std::span<const Index> dofs,
                              const Matrix<Scalar>& change) {
  const auto k = static_cast<Eigen::Index>(dofs.size());
  Correction<Scalar> c;
  c.columns = columns;
  Matrix<Scalar> held(k, k);
  for (Eigen::Index i = 0; i < k; ++i) held.row(i) = columns.row(dofs[static_cast<std::size_t>(i)]);
  Matrix<Scalar> small = product(held, change);
  for (Eigen::Index i = 0; i < k; ++i) small(i, i) += 1.0;
  const double norm = one_norm(small);
  if (!eliminate(small)) return c;
  c.condition = norm * one_norm(small);
  c.small = product(change, small);
  return c;
}

}  // namespace

template <class Scalar>
void switch_axis(MatrixRef<Scalar> M, Eigen::Index i, std::span<Scalar> left, std::span<Scalar> right) {
  const Eigen::Index N = M.rows();
  const Scalar pivot = M(i, i);
  for (Eigen::Index j = 0; j < N; ++j) {
    const auto s = static_cast<std::size_t>(j);
    left[s] = (j == i ? M(j, i) + Scalar(1.0) : M(j, i)) / pivot;
    right[s] = j == i ? M(i, j) - Scalar(1.0) : M(i, j);
  }
  subtract_rank_one<Scalar>(M, left, right);
}

template <class Scalar>
void update_by_switches(MatrixRef<Scalar> inverse, std::span<const Index> dofs, const Matrix<Scalar>& change,
                        Eigen::Index first_new) {
  const detail::OneBlasThread one_thread;
  const auto N = static_cast<std::size_t>(inverse.rows());
  std::vector<Scalar> left(N);
  std::vector<Scalar> right(N);
  for (const Index dof : dofs)
    if (dof < first_new) switch_axis<Scalar>(inverse, dof, left, right);
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (std::size_t j = 0; j < dofs.size(); ++j)
      inverse(dofs[i], dofs[j]) += change(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  for (const Index dof : dofs) switch_axis<Scalar>(inverse, dof, left, right);
}

template <class Scalar>
double update_by_woodbury(MatrixRef<Scalar> inverse, std::span<const Index> dofs, const Matrix<Scalar>& change) {
  const detail::OneBlasThread one_thread;
  Matrix<Scalar> columns(inverse.rows(), static_cast<Eigen::Index>(dofs.size()));
  for (std::size_t j = 0; j < dofs.size(); ++j) columns.col(static_cast<Eigen::Index>(j)) = inverse.col(dofs[j]);
  const auto c = correction(columns, dofs, change);
  if (std::isfinite(c.condition)) subtract_product<Scalar>(inverse, product(c.columns, c.small), c.columns);
  return c.condition;
}

double update_by_woodbury_symmetric(MatrixRef<double> inverse, std::span<const Index> dofs, const MatX& change) {
  const detail::OneBlasThread one_thread;
  const Eigen::Index N = inverse.rows();
  MatX columns(N, static_cast<Eigen::Index>(dofs.size()));
  for (std::size_t j = 0; j < dofs.size(); ++j) {
    const Eigen::Index dof = dofs[j];
    auto column = columns.col(static_cast<Eigen::Index>(j));
    column.head(dof) = inverse.row(dof).head(dof).transpose();
    column.tail(N - dof) = inverse.col(dof).tail(N - dof);
  }
  auto c = correction<double>(columns, dofs, change);
  if (!std::isfinite(c.condition)) return c.condition;
  c.small = 0.5 * (c.small + c.small.transpose()).eval();
  const MatX left = c.columns * c.small;
  constexpr Eigen::Index strip = 96;
  for (Eigen::Index j = 0; j < N; j += strip) {
    const Eigen::Index width = std::min(strip, N - j);
    blas_subtract_product(&inverse(j, j), static_cast<int>(inverse.outerStride()), static_cast<int>(N - j),
                          static_cast<int>(width), &left(j, 0), static_cast<int>(N), &c.columns(j, 0),
                          static_cast<int>(N), static_cast<int>(left.cols()));
  }
  return c.condition;
}

bool invert(MatX& K) {
  const int n = static_cast<int>(K.rows());
  int info = 0;
  dpotrf_("L", &n, K.data(), &n, &info);
  if (info != 0) return false;
  dpotri_("L", &n, K.data(), &n, &info);
  if (info != 0) return false;
  K.triangularView<Eigen::StrictlyUpper>() = K.transpose();
  return true;
}

template void switch_axis<double>(MatrixRef<double>, Eigen::Index, std::span<double>, std::span<double>);
template void switch_axis<Counted>(MatrixRef<Counted>, Eigen::Index, std::span<Counted>, std::span<Counted>);
template void update_by_switches<double>(MatrixRef<double>, std::span<const Index>, const Matrix<double>&,
                                         Eigen::Index);
template void update_by_switches<Counted>(MatrixRef<Counted>, std::span<const Index>, const Matrix<Counted>&,
                                          Eigen::Index);
template double update_by_woodbury<double>(MatrixRef<double>, std::span<const Index>, const Matrix<double>&);
template double update_by_woodbury<Counted>(MatrixRef<Counted>, std::span<const Index>, const Matrix<Counted>&);

}  // namespace stylet::paper

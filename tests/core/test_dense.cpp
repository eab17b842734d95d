// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"
#include "core/dense_lu.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace stylet {
namespace {

/// Matrix sizes around multiples of the tile size.
constexpr std::array<Eigen::Index, 13> kSizes{1, 2, 3, 5, 8, 13, 23, 24, 25, 48, 71, 123, 180};

/// A matrix with entries between −1 and 1, the same on every run.
MatX some_matrix(Eigen::Index rows, Eigen::Index columns) {
  MatX A(rows, columns);
  unsigned state = 12345U + static_cast<unsigned>(rows * 1000 + columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      state = 1664525U * state + 1013904223U;
      A(i, j) = static_cast<double>(state >> 8) / static_cast<double>(1U << 23) - 1.0;
    }
  }
  return A;
}

TEST(DenseCholesky, solves_for_one_and_for_several_columns) {
  for (const Eigen::Index n : kSizes) {
    const MatX root = some_matrix(n, n);
    const MatX A = root * root.transpose() + static_cast<double>(n) * MatX::Identity(n, n);
    MatX L = A;
    ASSERT_TRUE(dense::factorise(L)) << n;
    for (const Eigen::Index columns : {1, 3, 4, 5, 7, 30}) {
      const MatX b = some_matrix(n, columns);
      MatX x = b;
      dense::solve_lower(L, 0, x);
      dense::solve_upper(L, x);
      EXPECT_LT((A * x - b).norm(), 1e-12 * b.norm()) << n << " × " << columns;
    }
  }
}

TEST(DenseCholesky, leaves_zeros_before_a_start_and_goes_on_from_columns_that_are_done) {
  for (const Eigen::Index n : kSizes) {
    const MatX root = some_matrix(n, n);
    const MatX A = root * root.transpose() + static_cast<double>(n) * MatX::Identity(n, n);
    MatX L = A;
    L.triangularView<Eigen::StrictlyUpper>().setConstant(std::numeric_limits<double>::quiet_NaN());
    ASSERT_TRUE(dense::factorise(L)) << n;
    for (const Eigen::Index start : {n / 5, n / 2, n - 1}) {
      MatX b = some_matrix(n, 3);
      b.topRows(start).setZero();
      MatX x = b;
      dense::solve_lower(L, start, x);
      EXPECT_TRUE(x.topRows(start).isZero(0.0)) << n << ", " << start;
      dense::solve_upper(L, x);
      EXPECT_LT((A * x - b).norm(), 1e-12 * b.norm()) << n << ", " << start;

      const Eigen::Index done = start / dense::kTile * dense::kTile;
      MatX other = L;
      MatX changed = A;
      changed.diagonal().tail(n - start).array() += 1.0;
      for (Eigen::Index j = done; j < n; ++j) other.col(j).tail(n - j) = changed.col(j).tail(n - j);
      ASSERT_TRUE(dense::factorise_from(other, done)) << n << ", " << start;
      MatX y = b;
      dense::solve_lower(other, 0, y);
      dense::solve_upper(other, y);
      EXPECT_LT((changed * y - b).norm(), 1e-12 * b.norm()) << n << ", " << start;

      // The first columns form a factor by themselves.
      if (start == 0) continue;
      MatX partly = A;
      ASSERT_TRUE(dense::factorise_first(partly, start)) << n << ", " << start;
      const MatX corner = A.topLeftCorner(start, start);
      const MatX given = some_matrix(start, 2);
      MatX z = given;
      dense::solve_lower(partly.topLeftCorner(start, start), 0, z);
      dense::solve_upper(partly.topLeftCorner(start, start), z);
      EXPECT_LT((corner * z - given).norm(), 1e-12 * given.norm()) << n << ", " << start;
    }
  }
}

TEST(DenseCholesky, stops_after_the_first_columns_and_leaves_what_is_left) {
  for (const Eigen::Index n : kSizes) {
    const MatX root = some_matrix(n, n);
    const MatX A = root * root.transpose() + static_cast<double>(n) * MatX::Identity(n, n);
    for (const Eigen::Index first : {Eigen::Index{0}, n / 3, n - 1, n}) {
      const Eigen::Index rest = n - first;
      MatX partly = A;
      ASSERT_TRUE(dense::factorise_first(partly, first)) << n << ", " << first;
      const MatX L = partly.topLeftCorner(first, first).triangularView<Eigen::Lower>();
      const MatX below = partly.bottomLeftCorner(rest, first);
      const MatX left = partly.bottomRightCorner(rest, rest).selfadjointView<Eigen::Lower>();
      EXPECT_LT((L * L.transpose() - A.topLeftCorner(first, first)).norm(), 1e-13 * A.norm()) << n << ", " << first;
      EXPECT_LT((below * L.transpose() - A.bottomLeftCorner(rest, first)).norm(), 1e-13 * A.norm())
          << n << ", " << first;
      EXPECT_LT((below * below.transpose() + left - A.bottomRightCorner(rest, rest)).norm(), 1e-13 * A.norm())
          << n << ", " << first;
    }
  }
}

TEST(DenseLu, solves_with_rows_that_must_be_swapped) {
  for (const Eigen::Index n : kSizes) {
    MatX A = some_matrix(n, n);
    A.diagonal().setZero();  // no pivot on the diagonal
    if (n == 1) A(0, 0) = 2.0;
    MatX LU = A;
    std::vector<int> pivots(static_cast<std::size_t>(n));
    ASSERT_TRUE(dense::factorise_lu(LU, pivots)) << n;
    const MatX b = some_matrix(n, 4);
    MatX x = b;
    dense::solve_lu(LU, pivots, x);
    EXPECT_LT((A * x - b).norm(), 1e-10 * A.norm() * x.norm()) << n;
  }
}

TEST(DenseLu, refuses_a_singular_matrix_and_one_that_is_not_finite) {
  std::vector<int> pivots(30);
  MatX twice = some_matrix(30, 30);
  twice.col(29) = twice.col(3);
  EXPECT_FALSE(dense::factorise_lu(twice, pivots));
  MatX broken = some_matrix(30, 30);
  broken(17, 11) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(dense::factorise_lu(broken, pivots));
}

TEST(DenseProduct, is_subtracted_whatever_the_sizes) {
  for (const Eigen::Index n : {1, 47, 48, 49, 123}) {
    const MatX A = some_matrix(n, n + 5);
    const MatX B = some_matrix(n + 5, 30);
    const MatX C = some_matrix(n, 30);
    MatX result = C;
    dense::subtract_product(result, A, B);
    EXPECT_LT((result - (C - A * B)).norm(), 1e-13 * (A.norm() * B.norm())) << n;
  }
}

TEST(DenseProduct, of_a_symmetric_matrix_is_that_of_any_other) {
  for (const Eigen::Index n : {1, 24, 125, 256, 257, 264, 300}) {
    MatX A = some_matrix(n, n);
    A = (A + A.transpose()).eval();
    for (const Eigen::Index columns : {1, 3, 6, 7}) {
      const MatX B = some_matrix(n, columns);
      MatX C = some_matrix(n, columns);
      const MatX expected = C - A * B;
      dense::subtract_symmetric_product(C, A, B);
      EXPECT_LT((C - expected).norm(), 1e-13 * A.norm() * B.norm()) << n << " × " << columns;
    }
  }
}

TEST(DenseProduct, of_small_blocks_is_summed_up) {
  for (const std::size_t count : {0, 1, 2, 7}) {
    std::vector<Mat3> A;
    std::vector<Mat3> B;
    Mat3 sum = Mat3::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      const MatX both = some_matrix(3, 6) * static_cast<double>(k + 1);
      A.emplace_back(both.leftCols(3));
      B.emplace_back(both.rightCols(3));
      sum += A.back() * B.back();
    }
    EXPECT_LT((dense::sum_of_products(A, B) - sum).norm(), 1e-14 * (1.0 + sum.norm())) << count;
  }
}

}  // namespace
}  // namespace stylet

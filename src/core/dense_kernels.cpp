// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_kernels.hpp"

#include "core/for_processors.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace stylet::dense {

namespace {

using Size = Eigen::Index;

constexpr Size kFour = 4;

/// C (4 Rows × Columns) −= A B; b(k, j) = b[k down + j across].
template <int Rows, int Columns>
STYLET_INLINE void subtract_block(double* c, Size ldc, const double* a, Size lda, const double* b, Size down,
                                  Size across, Size depth) {
  Four sum[Columns][Rows];
  for (int j = 0; j < Columns; ++j) {
    for (int i = 0; i < Rows; ++i) sum[j][i] = four(c + j * ldc + i * kFour);
  }
  for (Size k = 0; k < depth; ++k) {
    Four column[Rows];
    for (int i = 0; i < Rows; ++i) column[i] = four(a + k * lda + i * kFour);
    for (int j = 0; j < Columns; ++j) {
      const double factor = b[k * down + j * across];
      for (int i = 0; i < Rows; ++i) sum[j][i] -= column[i] * factor;
    }
  }
  for (int j = 0; j < Columns; ++j) {
    for (int i = 0; i < Rows; ++i) four(c + j * ldc + i * kFour) = sum[j][i];
  }
}

/// Processes all rows of `Columns` columns.
template <int Columns>
STYLET_INLINE void subtract_columns(double* c, Size ldc, const double* a, Size lda, const double* b, Size down,
                                    Size across, Size rows, Size depth) {
  constexpr int kTall = Columns == 1 ? 6 : 2;
  Size i = 0;
  for (; i + kTall * kFour <= rows; i += kTall * kFour)
    subtract_block<kTall, Columns>(c + i, ldc, a + i, lda, b, down, across, depth);
  for (; i + kFour <= rows; i += kFour) subtract_block<1, Columns>(c + i, ldc, a + i, lda, b, down, across, depth);
  for (; i < rows; ++i) {
    for (int j = 0; j < Columns; ++j) {
      double sum = c[i + j * ldc];
      for (Size k = 0; k < depth; ++k) sum -= a[i + k * lda] * b[k * down + j * across];
      c[i + j * ldc] = sum;
    }
  }
}

STYLET_INLINE void subtract_any(double* c, Size ldc, const double* a, Size lda, const double* b, Size down, Size across,
                                Size rows, Size columns, Size depth) {
  Size j = 0;
  for (; j + 4 <= columns; j += 4)
    subtract_columns<4>(c + j * ldc, ldc, a, lda, b + j * across, down, across, rows, depth);
  for (; j + 2 <= columns; j += 2)
    subtract_columns<2>(c + j * ldc, ldc, a, lda, b + j * across, down, across, rows, depth);
  if (j < columns) subtract_columns<1>(c + j * ldc, ldc, a, lda, b + j * across, down, across, rows, depth);
}

/// sums[i] = (r₀ + r₁) + (r₂ + r₃) for each of the four registers r = a, b, c, d.
STYLET_INLINE void add_up(const Four& a, const Four& b, const Four& c, const Four& d, double* sums) {
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd = __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  four(sums) = __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

/// c(i, j) = Σ_k a(k, i) b(k, j): four partial sums in one register, then the remaining k.
template <int Rows, int Columns>
STYLET_INLINE void dot_block(double* c, Size ldc, const double* a, Size lda, const double* b, Size ldb, Size depth) {
  Four sum[Rows][Columns];
  for (int i = 0; i < Rows; ++i) {
    for (int j = 0; j < Columns; ++j) sum[i][j] = Four{0.0, 0.0, 0.0, 0.0};
  }
  Size k = 0;
  for (; k + kFour <= depth; k += kFour) {
    for (int j = 0; j < Columns; ++j) {
      const Four right = four(b + k + j * ldb);
      for (int i = 0; i < Rows; ++i) sum[i][j] += four(a + k + i * lda) * right;
    }
  }
  for (int j = 0; j < Columns; ++j) {
    for (int i = 0; i < Rows; ++i) {
      if constexpr (Rows == kFour) {
        if (i == 0) add_up(sum[0][j], sum[1][j], sum[2][j], sum[3][j], c + j * ldc);
      } else {
        const Four& s = sum[i][j];
        c[i + j * ldc] = (s[0] + s[1]) + (s[2] + s[3]);
      }
      for (Size rest = k; rest < depth; ++rest) c[i + j * ldc] += a[rest + i * lda] * b[rest + j * ldb];
    }
  }
}

template <int Columns>
STYLET_INLINE void dot_columns(double* c, Size ldc, const double* a, Size lda, const double* b, Size ldb, Size rows,
                               Size depth) {
  Size i = 0;
  for (; i + 4 <= rows; i += 4) dot_block<4, Columns>(c + i, ldc, a + i * lda, lda, b, ldb, depth);
  for (; i < rows; ++i) dot_block<1, Columns>(c + i, ldc, a + i * lda, lda, b, ldb, depth);
}

STYLET_FOR_PROCESSORS
void subtract(double* c, Size ldc, const double* a, Size lda, const double* b, Size down, Size across, Size rows,
              Size columns, Size depth) {
  subtract_any(c, ldc, a, lda, b, down, across, rows, columns, depth);
}

STYLET_FOR_PROCESSORS
void dot(double* c, Size ldc, const double* a, Size lda, const double* b, Size ldb, Size rows, Size columns,
         Size depth) {
  Size j = 0;
  for (; j + 3 <= columns; j += 3) dot_columns<3>(c + j * ldc, ldc, a, lda, b + j * ldb, ldb, rows, depth);
  for (; j + 2 <= columns; j += 2) dot_columns<2>(c + j * ldc, ldc, a, lda, b + j * ldb, ldb, rows, depth);
  if (j < columns) dot_columns<1>(c + j * ldc, ldc, a, lda, b + j * ldb, ldb, rows, depth);
}

/// to −= factor × from
STYLET_INLINE void subtract_multiple(double* to, const double* from, double factor, Size count) {
  Size i = 0;
  for (; i + kFour <= count; i += kFour) four(to + i) -= four(from + i) * factor;
  for (; i < count; ++i) to[i] -= from[i] * factor;
}

/// Solves for `Columns` columns side by side: while one column waits for a result, the processor works on the others.
/// Groups of four rows begin at the same rows for every j; otherwise each load would have to wait for two stores.
template <int Columns>
STYLET_INLINE void lower_columns(const double* l, Size ldl, Size n, double* y, Size ldy) {
  const Size whole = n - n % kFour;
  for (Size j = 0; j < n; ++j) {
    const double* const factor = l + j * ldl;
    double known[Columns];
    for (int c = 0; c < Columns; ++c) known[c] = y[j + c * ldy];
    const auto one_by_one = [&](Size first, Size last) {
      for (Size i = first; i < last; ++i) {
        for (int c = 0; c < Columns; ++c) y[i + c * ldy] -= factor[i] * known[c];
      }
    };
    const Size fours = std::min(n, (j + kFour) / kFour * kFour);
    one_by_one(j + 1, fours);
    for (Size i = fours; i < whole; i += kFour) {
      const Four column = four(factor + i);
      for (int c = 0; c < Columns; ++c) four(y + i + c * ldy) -= column * known[c];
    }
    one_by_one(std::max(fours, whole), n);
  }
}

STYLET_FOR_PROCESSORS
void lower(const double* l, Size ldl, Size n, double* y, Size ldy, Size columns) {
  Size c = 0;
  for (; c + 4 <= columns; c += 4) lower_columns<4>(l, ldl, n, y + c * ldy, ldy);
  for (; c < columns; ++c) lower_columns<1>(l, ldl, n, y + c * ldy, ldy);
}

STYLET_FOR_PROCESSORS
void upper(const double* u, Size ldu, Size n, double* y, Size ldy, Size columns) {
  for (Size c = 0; c < columns; ++c) {
    double* x = y + c * ldy;
    for (Size j = n - 1; j >= 0; --j) {
      x[j] /= u[j + j * ldu];
      subtract_multiple(x, u + j * ldu, x[j], j);
    }
  }
}

/// A small upper triangle with explicit zeros below its diagonal, so that rows can be processed in groups of four.
struct Triangle {
  static_assert(kTile % (2 * kFour) == 0);
  double at[kTile * kTile] = {};

  STYLET_INLINE double* column(Size j) { return at + j * kTile; }
};

/// Column i of L⁻ᵀ is −1/L_ii Σ_(m < i) L_im × column m, where column m ends with 1/L_mm. Four columns are computed at
/// a time: first the contributions of all columns before them, then their contributions to each other.
STYLET_FOR_PROCESSORS
void invert(double* tile, Size ld, Size n) {
  Triangle inverse;
  for (Size first = 0; first < n; first += kFour) {
    const Size count = std::min(kFour, n - first);
    subtract_any(inverse.column(first), kTile, inverse.at, kTile, tile + first, ld, 1, first, count, first);
    for (Size i = first; i < first + count; ++i) {
      double* const column = inverse.column(i);
      for (Size m = first; m < i; ++m) subtract_multiple(column, inverse.column(m), tile[i + m * ld], first + kFour);
      const double last = 1.0 / tile[i + i * ld];
      for (Size k = 0; k < first + kFour; k += kFour) four(column + k) *= last;
      column[i] = last;
    }
  }
  for (Size i = 1; i < n; ++i) std::copy_n(inverse.column(i), i, tile + i * ld);
}

/// Multiplies `Columns` columns. The last rows come first, because row i needs the unchanged rows above it.
template <int Columns>
STYLET_INLINE void inverted_columns(const double* tile, Size ld, Size n, double* y, Size ldy) {
  Size i = n;
  for (; i % kFour != 0; --i) {
    const double* const column = tile + (i - 1) * ld;
    double above[Columns];
    dot_block<1, Columns>(above, 1, column, ld, y, ldy, i - 1);
    for (int c = 0; c < Columns; ++c) {
      double& x = y[i - 1 + c * ldy];
      x = x / column[i - 1] + above[c];
    }
  }
  for (; i > 0; i -= kFour) {
    const Size first = i - kFour;
    double sum[Columns][kFour];
    dot_block<kFour, Columns>(sum[0], kFour, tile + first * ld, ld, y, ldy, first);
    for (Size r = kFour - 1; r >= 0; --r) {
      const double* const column = tile + (first + r) * ld + first;
      for (int c = 0; c < Columns; ++c) {
        double* const x = y + first + c * ldy;
        for (Size k = 0; k < r; ++k) sum[c][r] += column[k] * x[k];
        x[r] = x[r] / column[r] + sum[c][r];
      }
    }
  }
}

/// For many columns: stores L⁻¹ as a whole, so that eight of its rows are processed at a time. The last rows come
/// first, as in inverted_columns().
STYLET_INLINE void inverted_many(const double* tile, Size ld, Size n, double* y, Size ldy, Size columns) {
  constexpr Size kRows = 2 * kFour;
  Triangle less;  // −L⁻¹, strict lower triangle and diagonal
  for (Size k = 0; k < n; ++k) {
    less.column(k)[k] = -1.0 / tile[k + k * ld];
    for (Size i = k + 1; i < n; ++i) less.column(k)[i] = -tile[k + i * ld];
  }
  for (Size i = n; i > 0;) {
    const Size first = (i - 1) / kRows * kRows;
    for (Size j = 0; j < columns; j += kFour) {
      const Size count = std::min(kFour, columns - j);
      double result[kRows * kFour] = {};
      subtract_any(result, kRows, less.at + first, kTile, y + j * ldy, 1, ldy, i - first, count, i);
      for (Size c = 0; c < count; ++c) std::copy_n(result + c * kRows, i - first, y + first + (j + c) * ldy);
    }
    i = first;
  }
}

STYLET_FOR_PROCESSORS
void inverted(const double* tile, Size ld, Size n, double* y, Size ldy, Size columns) {
  if (columns > kFour) {
    inverted_many(tile, ld, n, y, ldy, columns);
    return;
  }
  Size c = 0;
  for (; c + 2 <= columns; c += 2) inverted_columns<2>(tile, ld, n, y + c * ldy, ldy);
  if (c < columns) inverted_columns<1>(tile, ld, n, y + c * ldy, ldy);
}

/// Multiplies `Columns` columns in place. Rows are taken in ascending order, four at once: their original values first
/// contribute to all rows above the four, then to each other.
template <int Columns>
STYLET_INLINE void inverted_transposed_columns(const double* tile, Size ld, Size n, double* y, Size ldy) {
  for (Size i = 0; i < n; i += kFour) {
    const Size count = std::min(kFour, n - i);
    double less[Columns][kFour];
    for (int c = 0; c < Columns; ++c) {
      for (Size r = 0; r < count; ++r) less[c][r] = -y[i + r + c * ldy];
    }
    subtract_columns<Columns>(y, ldy, tile + i * ld, ld, less[0], 1, kFour, i, count);
    for (int c = 0; c < Columns; ++c) {
      double* const x = y + i + c * ldy;
      for (Size r = 0; r < count; ++r) {
        const double* const column = tile + (i + r) * ld + i;
        for (Size k = 0; k < r; ++k) x[k] -= column[k] * less[c][r];
        x[r] = -less[c][r] / column[r];
      }
    }
  }
}

STYLET_FOR_PROCESSORS
void inverted_transposed(const double* tile, Size ld, Size n, double* y, Size ldy, Size columns) {
  Size c = 0;
  for (; c + 4 <= columns; c += 4) inverted_transposed_columns<4>(tile, ld, n, y + c * ldy, ldy);
  for (; c + 2 <= columns; c += 2) inverted_transposed_columns<2>(tile, ld, n, y + c * ldy, ldy);
  if (c < columns) inverted_transposed_columns<1>(tile, ld, n, y + c * ldy, ldy);
}

STYLET_FOR_PROCESSORS
void divide_by_transposed(const double* l, Size ldl, Size n, double* x, Size ldx, Size rows) {
  for (Size j = 0; j < n; ++j) {
    double* column = x + j * ldx;
    subtract_columns<1>(column, ldx, x, ldx, l + j, ldl, 1, rows, j);
    const double inverse = 1.0 / l[j + j * ldl];
    for (Size i = 0; i < rows; ++i) column[i] *= inverse;
  }
}

STYLET_FOR_PROCESSORS
bool cholesky(double* a, Size lda, Size n) {
  for (Size j = 0; j < n; ++j) {
    double* column = a + j * lda;
    subtract_columns<1>(column + j, lda, a + j, lda, a + j, lda, 1, n - j, j);
    const double pivot = column[j];
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double root = std::sqrt(pivot);
    column[j] = root;
    const double inverse = 1.0 / root;
    for (Size i = j + 1; i < n; ++i) column[i] *= inverse;
  }
  return true;
}

/// Columns first … first + count − 1 of A from row `first` down, one after the other.
STYLET_FOR_PROCESSORS
bool lu_panel(double* a, Size lda, Size n, Size first, Size count, double tiny, int* pivots) {
  for (Size j = first; j < first + count; ++j) {
    double* const column = a + j * lda;
    const Size before = j - first;
    lower_columns<1>(a + first + first * lda, lda, before, column + first, lda);
    subtract_columns<1>(column + j, lda, a + j + first * lda, lda, column + first, 1, lda, n - j, before);
    Size pivot = j;
    for (Size i = j + 1; i < n; ++i) {
      if (std::abs(column[i]) > std::abs(column[pivot])) pivot = i;
    }
    pivots[j] = static_cast<int>(pivot);
    if (!(std::abs(column[pivot]) > tiny)) return false;
    if (pivot != j) {
      for (Size c = first; c < first + count; ++c) std::swap(a[j + c * lda], a[pivot + c * lda]);
    }
    const double divisor = column[j];
    for (Size i = j + 1; i < n; ++i) column[i] /= divisor;
  }
  return true;
}

/// C += Σ_k A_k B_k for 3 × 3 blocks, stored one after the other as nine numbers each.
STYLET_FOR_PROCESSORS
void add_products(double* c, const double* a, const double* b, std::size_t count) {
  Four sum[3][3] = {};  // [column of C][column of A]: nine sums that do not wait for each other
  for (std::size_t k = 0; k < count; ++k, a += 9, b += 9) {
    // A column is the first three of four numbers. The last column is loaded one element earlier and rotated; loading
    // it at its start would read past the end of the block.
    const Four last = four(a + 5);
    const Four column[3] = {four(a), four(a + 3), __builtin_shufflevector(last, last, 1, 2, 3, 0)};
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) sum[j][i] += column[i] * b[3 * j + i];
    }
  }
  for (int j = 0; j < 3; ++j) {
    const Four total = sum[j][0] + sum[j][1] + sum[j][2];
    for (int i = 0; i < 3; ++i) c[3 * j + i] += total[i];
  }
}

}  // namespace

// NOLINTBEGIN(performance-unnecessary-value-param): the results are written through the views

void subtract_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B) {
  subtract(C.data(), C.outerStride(), A.data(), A.outerStride(), B.data(), 1, B.outerStride(), C.rows(), C.cols(),
           A.cols());
}

void subtract_symmetric_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B) {
  constexpr Eigen::Index kColumns = 6;
  constexpr Eigen::Index kInCache = 256;  // half a megabyte, which is read quickly as a whole
  const Eigen::Index n = A.rows();
  if (n <= kInCache) {
    subtract_product(C, A, B);
    return;
  }
  for (Eigen::Index k = 0; k < n; k += kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    const Eigen::Index below = n - k - nk;
    for (Eigen::Index c = 0; c < B.cols(); c += kColumns) {
      const Eigen::Index count = std::min(kColumns, B.cols() - c);
      auto tile = C.block(k, c, nk, count);
      subtract_product(tile, A.block(k, k, nk, nk), B.block(k, c, nk, count));
      if (below == 0) continue;
      const auto column = A.block(k + nk, k, below, nk);
      subtract_product(C.block(k + nk, c, below, count), column, B.block(k, c, nk, count));
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kTile, kColumns> known(nk, count);
      transposed_product(known, column, B.block(k + nk, c, below, count));
      tile -= known;
    }
  }
}

void subtract_product_transposed(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B) {
  subtract(C.data(), C.outerStride(), A.data(), A.outerStride(), B.data(), B.outerStride(), 1, C.rows(), C.cols(),
           A.cols());
}

Mat3 sum_of_products(std::span<const Mat3> A, std::span<const Mat3> B) {
  assert(A.size() == B.size());
  Mat3 sum = Mat3::Zero();
  if (!A.empty()) add_products(sum.data(), A.front().data(), B.front().data(), A.size());
  return sum;
}

void transposed_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B) {
  dot(C.data(), C.outerStride(), A.data(), A.outerStride(), B.data(), B.outerStride(), C.rows(), C.cols(), A.rows());
}

void solve_lower_tile(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y) {
  lower(L.data(), L.outerStride(), L.rows(), Y.data(), Y.outerStride(), Y.cols());
}

void invert_tile(Eigen::Ref<MatX> L) {
  assert(L.rows() <= kTile);
  invert(L.data(), L.outerStride(), L.rows());
}

void solve_inverted_tile(const Eigen::Ref<const MatX>& tile, Eigen::Ref<MatX> Y) {
  assert(tile.rows() <= kTile);
  inverted(tile.data(), tile.outerStride(), tile.rows(), Y.data(), Y.outerStride(), Y.cols());
}

void solve_inverted_tile_transposed(const Eigen::Ref<const MatX>& tile, Eigen::Ref<MatX> Y) {
  inverted_transposed(tile.data(), tile.outerStride(), tile.rows(), Y.data(), Y.outerStride(), Y.cols());
}

void solve_upper_tile(const Eigen::Ref<const MatX>& U, Eigen::Ref<MatX> Y) {
  upper(U.data(), U.outerStride(), U.rows(), Y.data(), Y.outerStride(), Y.cols());
}

void divide_by_transposed_tile(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> X) {
  divide_by_transposed(L.data(), L.outerStride(), L.rows(), X.data(), X.outerStride(), X.rows());
}

bool factorise_lu_panel(Eigen::Ref<MatX> A, Eigen::Index first, Eigen::Index count, double tiny,
                        std::span<int> pivots) {
  return lu_panel(A.data(), A.outerStride(), A.rows(), first, count, tiny, pivots.data());
}

bool factorise_tile(Eigen::Ref<MatX> A) { return cholesky(A.data(), A.outerStride(), A.rows()); }

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet::dense

// SPDX-License-Identifier: GPL-3.0-or-later
#include "spd_inverse.hpp"

#include "blas_threads.hpp"
#include "stylet/core/mirror.hpp"
#include "stylet/core/parallel.hpp"

#include <algorithm>

extern "C" {
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m, const int* n,
            const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
}

namespace stylet::detail {
namespace {

constexpr int kPanel = 192;  // columns per panel; enough for efficient matrix products
constexpr double kOne = 1.0;
constexpr double kZero = 0.0;

}  // namespace

MatX inverse_from_factor(MatX L, const Progress& progress) {
  const OneBlasThread one_thread;
  const auto n = static_cast<int>(L.rows());
  const auto panels = static_cast<std::size_t>((n + kPanel - 1) / kPanel);
  const auto at = [n](int row, int column) { return static_cast<std::ptrdiff_t>(column) * n + row; };

  // X = L⁻¹ is lower triangular too: each panel of it solves the trailing part of L for a panel of the unit matrix.
  MatX X = MatX::Zero(n, n);
  for_each_in_parallel(
      panels,
      [&](std::size_t panel) {
        const int first = static_cast<int>(panel) * kPanel;
        const int width = std::min(kPanel, n - first);
        const int height = n - first;
        for (int k = first; k < first + width; ++k) X(k, k) = 1.0;
        dtrsm_("L", "L", "N", "N", &height, &width, &kOne, L.data() + at(first, first), &n, X.data() + at(first, first),
               &n);
      },
      progress, "compliance");

  // Xᵀ X, one panel of rows at a time. Column r of X is zero above row r, so the sums begin at the panel's first row.
  for_each_in_parallel(panels, [&](std::size_t panel) {
    const int first = static_cast<int>(panel) * kPanel;
    const int width = std::min(kPanel, n - first);
    const int height = n - first;
    const int columns = first + width;
    dgemm_("T", "N", &width, &columns, &height, &kOne, X.data() + at(first, first), &n, X.data() + at(first, 0), &n,
           &kZero, L.data() + at(first, 0), &n);
  });
  mirror_lower(L);
  return L;
}

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_lu.hpp"

#include <cmath>

namespace stylet::dense {

bool solve_unsymmetric(Eigen::Ref<MatX> A, Eigen::Ref<VecX> b) {
  constexpr double singular = 1e-14;
  const Eigen::Index n = A.rows();
  const double scale = A.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = 0;
    const double largest = A.col(k).tail(n - k).cwiseAbs().maxCoeff(&pivot);
    if (!(largest > singular * scale)) return false;
    pivot += k;
    if (pivot != k) {
      A.row(k).tail(n - k).swap(A.row(pivot).tail(n - k));
      std::swap(b[k], b[pivot]);
    }
    const Eigen::Index below = n - k - 1;
    if (below == 0) break;
    A.col(k).tail(below) /= A(k, k);
    for (Eigen::Index j = k + 1; j < n; ++j) A.col(j).tail(below) -= A(k, j) * A.col(k).tail(below);
    b.tail(below) -= b[k] * A.col(k).tail(below);
  }
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    b[k] /= A(k, k);
    b.head(k) -= b[k] * A.col(k).head(k);
  }
  return b.allFinite();
}

}  // namespace stylet::dense

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <Eigen/SparseCore>

#include <cholmod.h>

namespace stylet::detail {

/// Sparse Cholesky factor P K Pᵀ = L Lᵀ by CHOLMOD's supernodal method under a METIS ordering, on one thread, so that
/// the same matrix gives the same bits. Solving is const and may run in several threads at once.
/// @cite Chen2008 CHOLMOD @cite Karypis1998 METIS
class Cholesky {
 public:
  /// Why there is no factor.
  enum class Failure { none, not_positive_definite, out_of_memory, too_large, refused };

  Cholesky();
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// Orders and factorises.
  /// @param K symmetric, both triangles stored, compressed (3b × 3b)
  /// @param nodes pattern of K's 3×3 blocks, symmetric with diagonal, compressed (b × b); ordering it instead of K
  ///   costs a ninth
  Failure factorise(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& nodes,
                    const Progress& progress);

  /// CHOLMOD's own status number, for messages.
  [[nodiscard]] int status() const { return common_.status; }

  /// Column of K at which it was found not to be positive definite (Failure::not_positive_definite).
  [[nodiscard]] Index failed_column() const { return failed_column_; }

  /// x = K⁻¹ b (3b × k). Throws std::bad_alloc when memory runs out.
  [[nodiscard]] MatX solve(const MatX& b) const;

  [[nodiscard]] double megabytes() const;
  [[nodiscard]] Index entries() const;  ///< stored numbers of L

 private:
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  Index failed_column_ = -1;
};

}  // namespace stylet::detail

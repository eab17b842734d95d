// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <Eigen/SparseCore>

#include <cholmod.h>

#include <span>

namespace stylet::detail {

/// Sparse Cholesky factor P K Pᵀ = L Lᵀ by CHOLMOD's supernodal method with a METIS ordering. The caller may name nodes
/// to be eliminated last: the trailing block of L is then the Cholesky factor of the inverse of their compliance.
/// Solving is const and may run in several threads at once.
/// @cite Chen2008 CHOLMOD @cite Karypis1998 METIS
class Cholesky {
 public:
  /// Reason why factorise() made no factor.
  enum class Failure { none, not_positive_definite, out_of_memory, too_large, refused };

  Cholesky();
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// Computes the ordering and the factor.
  /// @param K symmetric, both triangles stored, compressed (3b × 3b)
  /// @param nodes pattern of K's 3×3 blocks, symmetric with diagonal, compressed (b × b); it has a ninth of K's
  ///   entries, so ordering it is cheaper
  /// @param last columns of `nodes` to be eliminated last, in this order, each once
  Failure factorise(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& nodes,
                    std::span<const int> last, const Progress& progress);

  /// CHOLMOD's status number, for messages.
  [[nodiscard]] int status() const { return common_.status; }

  /// Column at which K proved not to be positive definite (Failure::not_positive_definite).
  [[nodiscard]] Index failed_column() const { return failed_column_; }

  /// Solves x = K⁻¹ b (3b × k). Throws std::bad_alloc when memory runs out.
  [[nodiscard]] MatX solve(const MatX& b) const;

  /// The block of K⁻¹ among the nodes that were eliminated last, in their order (3l × 3l), symmetric to the last bit:
  /// (K⁻¹)_ll = (L_ll L_llᵀ)⁻¹. It takes one dense inverse and no solves.
  [[nodiscard]] MatX inverse_of_last(const Progress& progress) const;

  [[nodiscard]] double megabytes() const;
  [[nodiscard]] Index entries() const;  ///< number of stored entries of L

 private:
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  std::size_t last_ = 0;  // number of columns of K that were eliminated last
  Index failed_column_ = -1;
};

}  // namespace stylet::detail

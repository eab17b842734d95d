// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/paper/inverse_updates.hpp"
#include "stylet/fem/tissue.hpp"

#include <memory>

namespace stylet::paper {

/// K⁻¹ on the free degrees of freedom as a dense matrix [mm/N] (free × free). One solve for each column: time and
/// memory grow with the square of the mesh size.
MatX full_inverse(const Tissue& tissue, const Progress& progress = {});

/// The full inverse of the stiffness, updated in place as the mesh changes, with room for added nodes.
class DenseInverse {
 public:
  enum class Engine {
    bcs,      ///< boundary condition switches
    woodbury  ///< matrix inversion lemma (Woodbury), on the lower triangle
  };

  /// @param initial inverse that reset() restores; shared between simulations
  /// @param room largest number of added nodes
  DenseInverse(Engine engine, std::shared_ptr<const MatX> initial, int room);

  [[nodiscard]] Index dofs() const { return dofs_; }
  [[nodiscard]] bool has_room() const { return dofs_ + 3 <= values_.rows(); }

  /// Appends three degrees of freedom that are not attached to anything. Woodbury's formula needs K⁻¹ to exist before
  /// the change, so they stand on springs of stiffness 1/δ, and the next change() removes these springs exactly.
  /// Therefore δ need not be "infinite", and a δ of the size of the other compliances keeps the small matrix well
  /// conditioned.
  /// @return number of the first of the three degrees of freedom
  Index append_node();

  /// K ← K + V ΔK Vᵀ.
  /// @param dofs (k) degrees of freedom that ΔK belongs to
  /// @param change ΔK [N/mm] (k × k)
  /// @return condition number of the small matrix (Woodbury), or NaN (switches); infinite when the change would make K
  /// singular, in which case K⁻¹ is left unchanged
  double change(std::span<const Index> dofs, const MatX& change);

  /// Entry in row i, column j [mm/N].
  [[nodiscard]] double operator()(Index i, Index j) const { return i >= j ? values_(i, j) : values_(j, i); }

  /// u = K⁻¹ f (dofs). Allocates.
  [[nodiscard]] VecX operator*(const VecX& f) const;

  /// Restores the initial inverse exactly.
  void reset();

  /// Sets δ as a multiple of the mean diagonal entry of the initial inverse; the paper's "very large" means 1e6 and
  /// more.
  void set_springs(double multiple) { delta_ = multiple * mean_diagonal_; }

  [[nodiscard]] Engine engine() const { return engine_; }
  [[nodiscard]] double megabytes() const;

 private:
  [[nodiscard]] MatrixRef<double> used() { return values_.topLeftCorner(dofs_, dofs_); }

  Engine engine_;
  std::shared_ptr<const MatX> initial_;
  MatX values_;  ///< leading dofs_ rows and columns are in use; only the lower triangle is valid
  Index dofs_ = 0;
  Index settled_ = 0;  ///< degrees of freedom from here on stand on springs (Woodbury), or are unattached (switches)
  double mean_diagonal_ = 0.0;
  double delta_ = 0.0;  ///< [mm/N]
};

}  // namespace stylet::paper

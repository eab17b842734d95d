// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/paper/inverse_updates.hpp"
#include "stylet/fem/tissue.hpp"

#include <memory>

namespace stylet::paper {

/// K⁻¹ on the free degrees of freedom, written out [mm/N] (free × free). One solve a column: time and memory grow with
/// the square of the mesh.
MatX full_inverse(const Tissue& tissue, const Progress& progress = {});

/// The full inverse of the stiffness, kept and changed in place as the mesh changes, with room for added nodes.
class DenseInverse {
 public:
  enum class Engine {
    bcs,      ///< boundary condition switches
    woodbury  ///< matrix inversion lemma, on the lower triangle
  };

  /// @param initial what reset() goes back to; shared between simulations
  /// @param room largest number of nodes added
  DenseInverse(Engine engine, std::shared_ptr<const MatX> initial, int room);

  [[nodiscard]] Index dofs() const { return dofs_; }
  [[nodiscard]] bool has_room() const { return dofs_ + 3 <= values_.rows(); }

  /// Three degrees of freedom that nothing is attached to yet. Woodbury needs K⁻¹ to exist before the change, so they
  /// stand on springs of 1/δ each, and the next change() takes the springs away again: with that δ need not be
  /// "infinite", and a δ of the size of the other compliances keeps the small matrix well conditioned.
  /// @return the first of them
  Index append_node();

  /// K ← K + V ΔK Vᵀ. @param dofs (k) @param change ΔK [N/mm] (k × k)
  /// @return condition number of the small matrix (Woodbury), NaN for switches, infinite when the change makes K
  /// singular: then K⁻¹ is what it was
  double change(std::span<const Index> dofs, const MatX& change);

  /// Row i, column j [mm/N].
  [[nodiscard]] double operator()(Index i, Index j) const { return i >= j ? values_(i, j) : values_(j, i); }

  /// u = K⁻¹ f (dofs). Allocates.
  [[nodiscard]] VecX operator*(const VecX& f) const;

  /// Back to the initial inverse, exactly.
  void reset();

  /// δ as a multiple of the mean diagonal of the initial inverse; the paper's "very large" would be 1e6 and more.
  void set_springs(double multiple) { delta_ = multiple * mean_diagonal_; }

  [[nodiscard]] Engine engine() const { return engine_; }
  [[nodiscard]] double megabytes() const;

 private:
  [[nodiscard]] MatrixRef<double> used() { return values_.topLeftCorner(dofs_, dofs_); }

  Engine engine_;
  std::shared_ptr<const MatX> initial_;
  MatX values_;  ///< leading dofs_ rows and columns in use; the lower triangle counts
  Index dofs_ = 0;
  Index settled_ = 0;  ///< degrees of freedom from here on stand on springs (Woodbury), or nowhere (switches)
  double mean_diagonal_ = 0.0;
  double delta_ = 0.0;  ///< [mm/N]
};

}  // namespace stylet::paper

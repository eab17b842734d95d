// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"
#include "needle/load_pulls.hpp"
#include "needle/scaled_chain.hpp"
#include "needle/shifted_factor.hpp"
#include "needle/virtual_work.hpp"
#include "stylet/needle/needle.hpp"

#include <span>
#include <vector>

namespace stylet::beam {

/// Gradient and Hessian of the potential energy and the Hessian's factor L, for a shape under dead loads. The unknowns
/// are those of ScaledChain, with which the elastic part of the Hessian is the unit matrix. J is the derivative of the
/// load points with respect to them.
class BeamTangent {
 public:
  BeamTangent(const BeamShape& shape, int load_capacity);

  /// Computes gradient, Hessian, factor and L⁻¹Jᵀ for these loads.
  /// @param base_rotation base axes to LPS
  /// @param springs [N/mm] LPS, one per load, or empty: added to the Hessian as Jᵀ G J
  /// @return false when the Hessian is not positive definite and Indefinite::give_up was asked for; there is no factor
  ///   then
  bool assemble(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift);
  /// The same work in two pieces: factorise() does everything except L⁻¹Jᵀ, which solve() computes.
  bool factorise(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                 std::span<const Mat3> springs, Indefinite otherwise);
  void solve();

  /// Computes J H⁻¹ Jᵀ [mm/N] (3w × 3w) LPS and -J H⁻¹ g [mm] (3w) LPS.
  void condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const;
  /// Computes part of J H⁻¹ Jᵀ: the rows and columns of the loads first … last − 1, for these loads and the loads
  /// before them. @param first a multiple of kCondensed
  void condense(Eigen::Ref<MatX> compliance, Eigen::Index first, Eigen::Index last) const;

  [[nodiscard]] Eigen::Index load_count() const { return loads_.count(); }

  /// Adds a load. Its columns of Jᵀ are computed for its current position, with the derivatives of the chain, the
  /// Hessian and the other columns as assemble() left them.
  /// @param loads (w) the current loads, or the leading ones of them, followed by the new load
  /// @param compliance [mm/N] (3 × 3w) LPS output: the last three rows of J H⁻¹ Jᵀ
  /// @return false, with nothing changed, when there is no room, no factor, or w is larger than the number of current
  ///   loads plus one
  bool append(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
              Eigen::Ref<MatX> compliance);

  /// Computes the gradient for this shape and these loads; Hessian, J and springs stay as assemble() left them.
  /// @param free output: -J H⁻¹ g [mm] (3w) LPS
  /// @return false, with nothing changed, when there is no factor or there are more loads than in the tangent
  bool relax(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
             Eigen::Ref<VecX> free);

  /// Largest out-of-balance moment of all elements, max_e |diag(EI, EI, GJ) Δκ_e - (1/l) Σ_c (∂r_c/∂κ_e)ᵀ f_c| [N mm].
  [[nodiscard]] double largest_imbalance(const BeamShape& shape, const Mat3& base_rotation,
                                         std::span<const PointLoad> loads);

  /// Adds the Newton step for these loads to the curvature.
  void step(std::span<const PointLoad> loads, BeamShape& shape);

  /// Gradient ∂Π/∂κ [N mm²] and Hessian ∂²Π/∂κ² [N mm³] in the order of BeamShape::curvature. For tests; they allocate.
  [[nodiscard]] VecX gradient() const;
  [[nodiscard]] MatX hessian() const;
  /// Multiple of the elastic Hessian that was added to make the sum positive definite; 0 below the buckling load.
  [[nodiscard]] double elastic_shift() const { return hessian_.shift(); }

 private:
  void reserve(Eigen::Index loads);
  void add_load(const BeamShape& shape, const Mat3& base_rotation, const PointLoad& load);
  void assemble_energy(const BeamShape& shape);
  void add_springs(std::span<const Mat3> springs);
  void move_loads(Eigen::Ref<VecX>& free) const;
  template <class Function>
  void for_groups(Function&& function) const;
  [[nodiscard]] Eigen::Index start(Eigen::Index first_load, Eigen::Index last_load) const {
    return chain_.row(loads_.last_moved(first_load, last_load));
  }

  ScaledChain chain_;
  LoadPulls loads_;          ///< the w loads of J
  VirtualWork work_;         ///< for the loads of the last gradient or residual
  ShiftedFactor hessian_;    ///< (3n × 3n)
  VecX g_;                   ///< (3n) gradient
  VecX z_;                   ///< (3n) L⁻¹ g
  VecX step_;                ///< (3n) work space of step()
  std::vector<Mat3> lever_;  ///< (n) Σ_c [f_c]× ∂r_c/∂y_e over the loads in and beyond element e
  VecX force_;               ///< [N] (3w) LPS, forces of the loads in the gradient
  VecX less_;                ///< [N] (3w) LPS, force_ − forces given to step()
  MatX Y_;                   ///< (3n × 3 capacity) L⁻¹ Jᵀ; between factorise() and solve() it holds Jᵀ
};

}  // namespace stylet::beam

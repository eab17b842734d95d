// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"
#include "stylet/needle/needle.hpp"

#include <span>
#include <vector>

namespace stylet::beam {

/// Gradient, Hessian and their factor for a shape under dead loads, in scaled unknowns y: κ_e = scale ∘ y, so that the
/// elastic part of the Hessian is the unit matrix. Unknowns run from the tip to the base: then a load touches only the
/// end of its column of Jᵀ, and forward substitution keeps the zeros before it.
class BeamTangent {
 public:
  BeamTangent(const BeamShape& shape, int load_capacity);

  /// Gradient, Hessian, factor, and L⁻¹Jᵀ for these loads. @param base_rotation base axes to LPS
  /// @param springs [N/mm] LPS, one per load or none: added to the Hessian as Jᵀ G J
  /// @return false where it was given up: there is no factor then
  bool assemble(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift);
  /// The same in two pieces: all but L⁻¹Jᵀ, then that.
  bool factorise(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                 std::span<const Mat3> springs, Indefinite otherwise);
  void solve();

  /// J H⁻¹ Jᵀ [mm/N] (3w × 3w) LPS and -J H⁻¹ g [mm] (3w) LPS.
  void condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const;
  /// Of the first of both the rows and columns of loads first … last − 1, as far as they are of those and the loads
  /// before them. @param first a multiple of kCondensed
  void condense(Eigen::Ref<MatX> compliance, Eigen::Index first, Eigen::Index last) const;

  [[nodiscard]] Eigen::Index load_count() const { return static_cast<Eigen::Index>(last_pull_.size()); }

  /// Adds a load after the first ones there: its column of Jᵀ for where it is now, with the levers, the Hessian and the
  /// other columns of assemble().
  /// @param loads (w) those there, or the first of them, and the new one last
  /// @param compliance [mm/N] (3 × 3w) LPS rows of J H⁻¹ Jᵀ, written
  /// @return false, and nothing done, when there is no room or no factor, or there were fewer
  bool append(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
              Eigen::Ref<MatX> compliance);

  /// Gradient for this shape and these loads; Hessian, J and springs as assemble() left them.
  /// @param free -J H⁻¹ g [mm] (3w) LPS, written
  /// @return false, and nothing done, when there were fewer loads, or there is no factor
  bool relax(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
             Eigen::Ref<VecX> free);

  /// Largest out-of-balance moment of any element, max_e |diag(EI, EI, GJ) Δκ_e - (1/l) Σ_c (∂r_c/∂κ_e)ᵀ f_c| [N mm].
  [[nodiscard]] double largest_imbalance(const BeamShape& shape, const Mat3& base_rotation,
                                         std::span<const PointLoad> loads);

  /// Adds the Newton step for these loads to the curvature.
  void step(std::span<const PointLoad> loads, BeamShape& shape);

  /// Gradient ∂Π/∂κ [N mm²] and Hessian ∂²Π/∂κ² [N mm³] in the order of BeamShape::curvature; for checks, allocates.
  [[nodiscard]] VecX gradient() const;
  [[nodiscard]] MatX hessian() const;
  /// Multiple of the elastic Hessian that was added to make it positive definite, 0 below the buckling load.
  [[nodiscard]] double elastic_shift() const { return elastic_shift_; }

 private:
  void reserve(Eigen::Index loads);
  void keep_first(std::size_t loads);
  void sum_work(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads);
  void locate(const BeamShape& shape, const Mat3& base_rotation, const PointLoad& load);
  void assemble_energy(const BeamShape& shape);
  [[nodiscard]] bool factorise_shifted(Indefinite otherwise);
  void assemble_jacobian(const Mat3& base_rotation, Eigen::Index load);
  void add_springs(std::span<const Mat3> springs);
  void move_loads(Eigen::Ref<VecX>& free) const;
  template <class Function>
  void for_groups(Function&& function) const;
  [[nodiscard]] Eigen::Index row(int e) const { return dof(elements_ - 1 - e); }
  [[nodiscard]] Eigen::Index start(Eigen::Index first_load, Eigen::Index last_load) const;

  int elements_;
  std::vector<Vec3> scale_;            ///< (n) κ_e = scale_e ∘ y_e, scale_e = (weight_e l diag(EI, EI, GJ))^-1/2
  std::vector<Pull> pulls_;            ///< base axes, load by load
  std::vector<Pull> acting_;           ///< pulls of sum_work(), …
  std::vector<int> next_;              ///< … for each the next one on the same element, or -1, …
  std::vector<int> first_;             ///< (n) … and the first one of an element
  std::vector<Vec3> work_;             ///< (n) Σ_c (∂r_c/∂κ_e)ᵀ f_c [N mm²]
  unsigned work_revision_ = 0;         ///< of the shape that work_ is of, …
  Mat3 work_rotation_ = Mat3::Zero();  ///< … and the base, …
  std::vector<PointLoad> work_loads_;  ///< … and the loads
  std::vector<int> last_pull_;         ///< (w) where in pulls_ each load's pulls end
  std::vector<int> last_moved_;        ///< (w) element nearest the tip that moves the load point, -1 = none
  VecX force_;                         ///< [N] (3w) LPS
  VecX less_;                          ///< [N] (3w) by how much forces have fallen since
  MatX H_, L_;                         ///< (3n × 3n) lower triangles, of L_ with its tiles' inverses
  VecX g_, z_, step_;                  ///< (3n) gradient, L⁻¹ g, work
  MatX spin_, shift_;                  ///< (3n × 3) scaled Ω_eᵀ, D_eᵀ stacked from the tip
  std::vector<Mat3> lever_;            ///< (n) Σ_c [f_c]× ∂r_c/∂y_e over the loads in and beyond element e
  MatX Y_;                             ///< (3n × 3 capacity) L⁻¹ Jᵀ
  double elastic_shift_ = 0.0;
  bool factorised_ = false;  ///< not where it was given up
};

}  // namespace stylet::beam

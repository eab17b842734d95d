// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/bar_stiffness.hpp"
#include "needle/block_band.hpp"
#include "needle/middle_nodes.hpp"
#include "needle/tet_shape.hpp"
#include "stylet/needle/needle.hpp"

#include <span>
#include <vector>

namespace stylet::tet {

/// Stiffness of a bar of tetrahedra at its current shape, with its factor L. The middle nodes of every segment are
/// eliminated first (MiddleNodes), which leaves 15 unknowns per layer, coupled only to those of neighbouring layers
/// (BlockBand). J is the derivative of the load points with respect to the displacement.
class TetTangent {
 public:
  TetTangent(const TetShape& shape, int load_capacity);

  /// Computes gradient, stiffness, factor and L⁻¹Jᵀ for these loads.
  /// @param base_rotation base axes to LPS
  /// @param springs [N/mm] LPS, one per load, or empty: added to the stiffness as Jᵀ G J
  /// @return false when the stiffness is not positive definite and Indefinite::give_up was asked for; there is no
  ///   factor then
  bool assemble(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift);

  /// Computes J K⁻¹ Jᵀ [mm/N] (3w × 3w) LPS and -J K⁻¹ g [mm] (3w) LPS.
  void condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const;

  /// Computes the gradient for this shape and these loads; stiffness, J and springs stay as assemble() left them.
  /// @param free output: -J K⁻¹ g [mm] (3w) LPS
  /// @return false, with nothing changed, when there is no factor or there are more loads than in the tangent
  bool relax(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads, Eigen::Ref<VecX> free);

  /// Adds the Newton step for these loads to the displacement.
  void step(std::span<const PointLoad> loads, TetShape& shape);

  /// Multiple of the material part that was added to make the stiffness positive definite; 0 below the buckling load.
  [[nodiscard]] double material_shift() const { return material_shift_; }

  /// Gradient [N] and stiffness [N/mm] in the order of TetShape::displacement, without springs and shift. For tests;
  /// they allocate.
  [[nodiscard]] VecX gradient() const { return gradient_; }
  [[nodiscard]] MatX stiffness(const TetShape& shape) const { return stiffness_.whole(shape); }

 private:
  void reserve(Eigen::Index loads);
  void assemble_loads(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads);
  void assemble_gradient(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads);
  [[nodiscard]] bool factorise(double shift);
  void add_springs(const Mat3& base_rotation, std::span<const Mat3> springs);
  void move_loads(Eigen::Ref<VecX>& free) const;
  [[nodiscard]] bool factorise_shifted(const Mat3& base_rotation, std::span<const Mat3> springs, Indefinite otherwise);
  [[nodiscard]] Eigen::Index start(Eigen::Index first_load, Eigen::Index last_load) const;

  BarStiffness stiffness_;
  MiddleNodes middle_;
  BlockBand band_;  ///< matrix of the layers 1…n, then its factor L
  VecX gradient_;   ///< [N] in the order of TetShape::displacement
  VecX z_;          ///< (15 per segment) L⁻¹ of the gradient that middle_ has reduced to the layers
  VecX step_;       ///< (15 per segment) work space of step()
  std::vector<AxisCurve::Weights> loads_;  ///< (w) weights of the nodes on which each load acts
  VecX force_;                             ///< [N] (3w) LPS, forces of the loads in the gradient
  MatX Y_;                                 ///< (15 per segment × 3 capacity) L⁻¹ Jᵀ
  double material_shift_ = 0.0;
  bool factorised_ = false;  ///< whether the last assemble() made a factor
};

}  // namespace stylet::tet

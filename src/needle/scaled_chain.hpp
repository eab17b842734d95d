// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"

#include <span>
#include <vector>

namespace stylet::beam {

/// The unknowns of the chain in units with which the elastic part of the Hessian is the unit matrix, and the first
/// derivatives in these units. The unknowns are y with κ_e = scale_e ∘ y_e, three per element, ordered from the tip to
/// the base. With this order a load affects only the last rows of its column of Jᵀ, and forward substitution keeps the
/// zeros before them. Nothing allocates after construction.
class ScaledChain {
 public:
  /// Takes the scales from the shape's stiffness at this time.
  explicit ScaledChain(const BeamShape& shape);

  [[nodiscard]] int elements() const { return static_cast<int>(scale_.size()); }
  /// Total number of unknowns.
  [[nodiscard]] Eigen::Index rows() const { return dof(elements()); }
  /// First unknown of an element; rows() for the element -1, which stands for "none".
  [[nodiscard]] Eigen::Index row(int element) const { return dof(elements() - 1 - element); }
  /// (elastic_weight_e l diag(EI, EI, GJ))^-1/2 [N^-1/2 mm^-3/2]
  [[nodiscard]] const Vec3& scale(int element) const { return scale_[static_cast<std::size_t>(element)]; }

  /// Computes the derivatives for the current shape.
  void update(const BeamShape& shape);
  /// BeamShape::spin() and shift() of an element with respect to y_e, base axes.
  [[nodiscard]] Mat3 spin(int element) const { return spin_.middleRows<3>(row(element)).transpose(); }
  [[nodiscard]] Mat3 shift(int element) const { return shift_.middleRows<3>(row(element)).transpose(); }
  /// Transposed spins of all elements, one below the other (rows × 3).
  [[nodiscard]] const MatX& spins() const { return spin_; }

  /// Computes the columns of Jᵀ of one load, where J is the derivative of its point [mm] in LPS with respect to y.
  /// @param pulls pulls of the load, for the shape of the last update()
  /// @param base_rotation base axes to LPS
  void motion(std::span<const Pull> pulls, const Mat3& base_rotation,
              Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 3>> columns) const;

 private:
  std::vector<Vec3> scale_;  ///< (elements)
  MatX spin_;                ///< (rows × 3) transposed spins, one below the other
  MatX shift_;               ///< (rows × 3) transposed shifts, one below the other
};

}  // namespace stylet::beam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"

namespace stylet {

/// Change of a hole's stiffness since the needle's tangent was made, and what it does in a Newton step with that
/// tangent. With the compliance N of the needle on the hole's older stiffness, the hole's index h and a change of
/// stiffness G, the hole moves by u = N_hh φ + what it would move by without the change, and bears the additional force
///   φ = −G u = −G (I + N_hh G)⁻¹ (motion of the hole without the change)        (Woodbury's identity).
/// docs/theory/needle.md, "Force of the hole". Nothing allocates after construction.
class GuideChange {
 public:
  /// @param rows three for each load, that of the hole included
  explicit GuideChange(Eigen::Index rows) : by_hole_(MatX::Zero(rows, 3)), before_(VecX::Zero(rows)) {}

  /// Takes over a tangent, in which nothing has changed yet.
  /// @param by_hole [mm/N] (rows × 3) motion of the hole and of the loads after it by a push at the hole
  void take(const Eigen::Ref<const MatX>& by_hole) {
    by_hole_.topRows(by_hole.rows()) = by_hole;
    stiffer_.setZero();
  }
  /// Adds a load to that tangent. @param loads number of loads before it, that of the hole included
  void append(Eigen::Index loads, const Mat3& by_hole) { by_hole_.middleRows<3>(3 * loads) = by_hole; }

  /// Whether steps with that tangent lead to the equilibrium, although the stiffness has changed. @param change [N/mm]
  [[nodiscard]] bool is_small(const Mat3& change) const { return softening(change).norm() <= kMostSoftened; }
  /// Begins a step.
  /// @param change [N/mm] @param loads at its start @param motion [mm] of the hole in it, with unchanged loads and
  /// without the change
  void begin(const Mat3& change, std::span<const PointLoad> loads, const Vec3& motion);
  /// φ [N] in this step. @param loads at its end
  [[nodiscard]] Vec3 force(std::span<const PointLoad> loads) const;
  /// φ [N] with unchanged loads.
  [[nodiscard]] Vec3 force() const { return -stiffer_ * motion_; }
  /// (3w × 3) [mm/N] Motion of the first w loads after the hole by a force there.
  [[nodiscard]] auto by_hole(std::size_t w) const { return by_hole_.middleRows(3, 3 * static_cast<Eigen::Index>(w)); }

 private:
  /// (I + N_hh G)⁻¹: motion of the hole with the change over that without.
  [[nodiscard]] Mat3 softening(const Mat3& change) const {
    return (Mat3::Identity() + by_hole_.topLeftCorner<3, 3>() * change).inverse();
  }

  /// Norm of (I + N_hh G)⁻¹, √3 without a change, up to which the tangent serves; it grows where the hole becomes
  /// softer. Raised, fewer tangents are made, and iterations converge more slowly.
  static constexpr double kMostSoftened = 8.0;
  MatX by_hole_;                 ///< [mm/N] (rows × 3)
  VecX before_;                  ///< [N] (rows) the loads after the hole at the start of the step
  Mat3 stiffer_ = Mat3::Zero();  ///< [N/mm] G (I + N_hh G)⁻¹ in this step
  Vec3 motion_ = Vec3::Zero();   ///< [mm] of the hole in this step, with unchanged loads and without the change
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet {

/// Force over depth of a dent in tissue that stiffens: F = k₁ z + k₂ z², k₁ = 1 / compliance. Convex and elastic;
/// k₂ = 0 is linear. docs/theory/stiffening.md says where the law comes from and what it leaves out.
struct DentLaw {
  double compliance = 0.0;      ///< [mm/N] z/F of a small dent
  double stiffening_MPa = 0.0;  ///< k₂ [N/mm²]

  /// [mm] Depth z under a force ≥ 0 [N].
  [[nodiscard]] double depth(double force) const;
  /// [mm/N] Slope dz/dF at a force ≥ 0 [N].
  [[nodiscard]] double slope(double force) const;
  /// [N mm] Complementary energy ∫ z dF from 0 to the force: ½ F z for a linear dent, more than that for a stiffening
  /// one.
  [[nodiscard]] double complementary_energy(double force) const;
  /// [mm/N] Compliance of the law with this k₂ in which `force` makes a dent of depth `depth`.
  /// @param depth [mm] > 0, and less than the depth √(force / k₂) of the law with k₁ = 0
  [[nodiscard]] static double compliance_for(double force, double depth, double stiffening_MPa);
};

/// How the tip moves the tissue under it by its own near field. A small force g moves it by C g. A larger force g makes
/// the dent C φ that a smaller force φ would make in linear tissue. φ has the direction of g, and its size follows
/// DentLaw with the mean of C's diagonal as compliance and √(gᵀ C g) as the measure of force. Therefore C φ is the
/// derivative of a potential Ψ, and the law is elastic in space. In a direction with the compliance c, which differs
/// from the mean compliance c̄ where C is not isotropic, the effective k₂ is (c̄ / c)^1.5 k₂.
struct TipDent {
  Mat3 compliance = Mat3::Zero();  ///< C [mm/N], symmetric, positive definite or zero
  double stiffening_MPa = 0.0;     ///< k₂ [N/mm²]

  /// The state of the dent under a force.
  struct Under {
    Vec3 linear = Vec3::Zero();             ///< φ [N], the force that would make this dent in linear tissue
    Mat3 slope = Mat3::Identity();          ///< ∂φ/∂g
    double complementary_energy_Nmm = 0.0;  ///< Ψ; its derivative with respect to the force is the dent C φ
  };
  [[nodiscard]] Under under(const Vec3& force) const;
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet {

/// Force over depth of a dent in tissue that stiffens: F = k₁ z + k₂ z², k₁ = 1 / compliance. Convex and elastic;
/// k₂ = 0 is linear. docs/theory/stiffening.md says where the law comes from and what it leaves out.
struct DentLaw {
  double compliance = 0.0;      ///< [mm/N] of a small dent
  double stiffening_MPa = 0.0;  ///< k₂ [N/mm²]

  /// [mm] z under a force ≥ 0 [N].
  [[nodiscard]] double depth(double force) const;
  /// [mm/N] dz/dF there.
  [[nodiscard]] double slope(double force) const;
  /// [N mm] ∫ z dF from 0, the complementary energy; of a linear dent ½ F z, of one that stiffens more.
  [[nodiscard]] double complementary_energy(double force) const;
  /// [mm/N] Compliance of the law with the same k₂ by which a force makes a dent of this depth, > 0 and less deep than
  /// without k₁.
  [[nodiscard]] static double compliance_for(double force, double depth, double stiffening_MPa);
};

/// How a tip moves the tissue under it by its own field: by C g while the dent is small. Under a larger force g the
/// dent is that of a smaller force φ in linear tissue: C φ. φ has the direction of g, and its size follows DentLaw for
/// the mean of C's diagonal, with √(gᵀ C g) as the measure of force: so C φ is the derivative of a potential Ψ, an
/// elastic law in space. Along the axis of a C that is not the same in all directions k₂ counts (mean / compliance
/// there)^1.5 times.
struct TipDent {
  Mat3 compliance = Mat3::Zero();  ///< C [mm/N], symmetric, positive definite or zero
  double stiffening_MPa = 0.0;     ///< k₂ [N/mm²]

  /// The dent under a force.
  struct Under {
    Vec3 linear = Vec3::Zero();             ///< φ [N] the force that would make this dent in linear tissue
    Mat3 slope = Mat3::Identity();          ///< ∂φ/∂g
    double complementary_energy_Nmm = 0.0;  ///< Ψ: its derivative with respect to the force is the dent C φ
  };
  [[nodiscard]] Under under(const Vec3& force) const;
};

}  // namespace stylet

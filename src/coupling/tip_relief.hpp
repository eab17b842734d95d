// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"

#include <cmath>

namespace stylet {

/// The relief: the displacement that the stiffening of the tissue under the tip takes off the linear displacement A g.
/// With C the needle's scale of A (ContactCompliance::needle_scale()), g_c the forces on the other points, g the force
/// on the tip, φ(g) the force that would make the same dent in linear tissue, and σ = g − φ, it is
///   of a point c:  C_c σ,      of the tip:  C σ + (I − φ′)ᵀ Σ_c C_cᵀ g_c.
/// The second term makes the law elastic: the displacements are the derivative of one energy with respect to the
/// forces.
class TipRelief {
 public:
  /// The relief of linear tissue: zero.
  TipRelief() = default;

  /// @param compliance outlives this @param force g [N] @param of_others Σ_c C_cᵀ g_c [mm]
  TipRelief(const ContactCompliance& compliance, const Vec3& force, const Vec3& of_others)
      : scale_(&compliance.needle_scale()), dent_(compliance.tip_dent().under(force)), force_(force) {
    const Mat3 C = scale_->topRows<3>();
    at_tip_ = C * spared() + kept().transpose() * of_others;
    at_tip_slope_ = C * kept() - change_of_share(compliance.tip_dent(), force, of_others);
    energy_Nmm_ = 0.5 * (force.dot(C * force - at_tip_) + spared().dot(of_others)) - dent_.complementary_energy_Nmm;
  }

  [[nodiscard]] bool is_any() const { return scale_ != nullptr; }
  /// [mm] LPS, the relief of a point.
  [[nodiscard]] Vec3 of(int point) const {
    if (!is_any()) return Vec3::Zero();
    return point == ContactCompliance::kTip ? at_tip_ : Vec3(scale_->middleRows<3>(3 * point) * spared());
  }
  /// [mm/N] Derivative of a point's relief with respect to the force on the tip; its transpose is the derivative of the
  /// tip's relief with respect to the force on the point.
  [[nodiscard]] Mat3 slope(int point) const {
    return point == ContactCompliance::kTip ? at_tip_slope_ : Mat3(scale_->middleRows<3>(3 * point) * kept());
  }
  /// [N mm] Energy stored in the tissue, minus half of the sum of all forces times their displacements.
  [[nodiscard]] double energy_Nmm() const { return energy_Nmm_; }
  /// φ [N]
  [[nodiscard]] const Vec3& linear() const { return dent_.linear; }
  /// φ′
  [[nodiscard]] const Mat3& share() const { return dent_.slope; }
  /// σ [N]
  [[nodiscard]] Vec3 spared() const { return force_ - dent_.linear; }
  /// I − φ′
  [[nodiscard]] Mat3 kept() const { return Mat3::Identity() - dent_.slope; }

 private:
  /// ∂(φ′ᵀ w)/∂g [mm/N], the second derivative of φ · w. With e = gᵀ C g, φ = s(e) g and S = 2 ds/de it is S (w (Cg)ᵀ +
  /// (Cg) wᵀ + (w·g) C) + 2 dS/de (w·g) (Cg)(Cg)ᵀ. At g = 0 it has no limit, but is bounded.
  [[nodiscard]] static Mat3 change_of_share(const TipDent& dent, const Vec3& g, const Vec3& w) {
    const Vec3 Cg = dent.compliance * g;
    const double e = g.dot(Cg);
    if (dent.stiffening_MPa <= 0.0 || !(e > 0.0)) return Mat3::Zero();
    const double c = dent.compliance.trace() / 3.0;
    const double q = std::sqrt(e / c);
    const double grows = 4.0 * dent.stiffening_MPa * c * c;
    const double root = std::sqrt(1.0 + grows * q);  // z′(q) = c / root, s = 2 / (1 + root)
    const double S = (1.0 / root - 2.0 / (1.0 + root)) / e;
    const double dS = (-0.5 * grows / (root * root * root) / (2.0 * c * q) - 1.5 * S) / e;
    const double along = w.dot(g);
    return S * (w * Cg.transpose() + Cg * w.transpose() + along * dent.compliance) +
           2.0 * dS * along * Cg * Cg.transpose();
  }

  const MatX* scale_ = nullptr;
  TipDent::Under dent_;
  Vec3 force_ = Vec3::Zero();
  Vec3 at_tip_ = Vec3::Zero();
  Mat3 at_tip_slope_ = Mat3::Zero();
  double energy_Nmm_ = 0.0;
};

}  // namespace stylet

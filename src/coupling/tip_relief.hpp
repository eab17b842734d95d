// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"

namespace stylet {

/// By how much less than A g the tissue gives way because it stiffens under the tip. With C the needle's scale of A
/// (ContactCompliance::needle_scale()), g_c the forces on the other points, g the one on the tip, φ(g) the force that
/// would make the same dent in linear tissue and σ = g − φ,
///   of a point c:  C_c σ,      of the tip:  C σ + (I − φ′)ᵀ Σ_c C_cᵀ g_c.
/// The second term is there because the whole is elastic: the derivative of one energy with respect to the forces.
class TipRelief {
 public:
  /// Of tissue that does not stiffen: nothing.
  TipRelief() = default;

  /// @param compliance outlives this @param force g [N] @param of_others Σ_c C_cᵀ g_c [mm]
  TipRelief(const ContactCompliance& compliance, const Vec3& force, const Vec3& of_others)
      : scale_(&compliance.needle_scale()), dent_(compliance.tip_dent().under(force)), force_(force) {
    const Mat3 C = scale_->topRows<3>();
    at_tip_ = C * spared() + kept().transpose() * of_others;
    energy_Nmm_ = 0.5 * (force.dot(C * force - at_tip_) + spared().dot(of_others)) - dent_.complementary_energy_Nmm;
  }

  [[nodiscard]] bool is_any() const { return scale_ != nullptr; }
  /// [mm] LPS
  [[nodiscard]] Vec3 of(int point) const {
    if (!is_any()) return Vec3::Zero();
    return point == ContactCompliance::kTip ? at_tip_ : Vec3(scale_->middleRows<3>(3 * point) * spared());
  }
  /// By how much less than A the point gives way to a little more force on the tip [mm/N]; its transpose is that of the
  /// tip by a little more force on the point. What changes φ′ itself is left out.
  [[nodiscard]] Mat3 slope(int point) const { return scale_->middleRows<3>(3 * point) * kept(); }
  /// By how much more than half of the sum of all forces times their displacements is stored in the tissue [N mm].
  [[nodiscard]] double energy_Nmm() const { return energy_Nmm_; }
  /// φ [N]
  [[nodiscard]] const Vec3& linear() const { return dent_.linear; }
  /// φ′
  [[nodiscard]] const Mat3& share() const { return dent_.slope; }

 private:
  [[nodiscard]] Vec3 spared() const { return force_ - dent_.linear; }
  [[nodiscard]] Mat3 kept() const { return Mat3::Identity() - dent_.slope; }

  const MatX* scale_ = nullptr;
  TipDent::Under dent_;
  Vec3 force_ = Vec3::Zero();
  Vec3 at_tip_ = Vec3::Zero();
  double energy_Nmm_ = 0.0;
};

}  // namespace stylet

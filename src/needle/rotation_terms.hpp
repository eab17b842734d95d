// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>

namespace stylet::beam {

/// Skew matrix: cross(a) * b = a × b.
[[nodiscard]] inline Mat3 cross(const Vec3& a) {
  Mat3 m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

/// Stumpff functions c_k(x) = Σ_j (-x)^j / (2j + k)!, k = 0…7, x ≥ 0. c_1 = sin θ / θ with x = θ². To rounding for any
/// x: no branch loses digits near zero. (Stumpff 1959.)
[[nodiscard]] std::array<double, 8> stumpff(double x);

/// How the centreline runs through an element that turns the frame by a rotation vector.
enum class ElementKind {
  arc,  ///< the turn is spread evenly: a piece of a circular helix
  rod,  ///< a joint at the element's start takes all of the turn, and a straight rod follows
};

/// What an element needs from its rotation vector φ [rad] (s κ for an arc up to s), with derivatives.
/// exp([φ]×) = I + c_1 [φ]× + c_2 [φ]×²  and  V(φ) = ∫₀¹ exp(σ[φ]×) dσ = I + c_2 [φ]× + c_3 [φ]×²; V is also the left
/// Jacobian of SO(3): exp([φ + δ]×) = exp([V δ]×) exp([φ]×) + O(δ²). The chord of the element per unit of its length,
/// in the frame of its start, is C(φ) e_z, with C = V for an arc and C = exp for a rod.
class RotationTerms {
 public:
  explicit RotationTerms(const Vec3& phi, ElementKind kind = ElementKind::arc)
      : phi_(phi), x_(phi.squaredNorm()), c_(stumpff(x_)), chord_(kind == ElementKind::arc ? 2 : 1) {}

  /// exp([φ]×)
  [[nodiscard]] Mat3 rotation() const { return series(1); }
  /// V(φ)
  [[nodiscard]] Mat3 mean_rotation() const { return series(2); }
  /// C(φ) e_z
  [[nodiscard]] Vec3 chord() const;
  /// ∂(C(φ) e_z)/∂φ
  [[nodiscard]] Mat3 chord_derivative() const;
  /// Hessian in φ of E : exp([φ]×)
  [[nodiscard]] Mat3 rotation_hessian(const Mat3& E) const { return hessian(1, E); }
  /// Hessian in φ of a · C(φ) e_z
  [[nodiscard]] Mat3 chord_hessian(const Vec3& a) const { return hessian(chord_, a * Vec3::UnitZ().transpose()); }

 private:
  /// I + c_k [φ]× + c_{k+1} [φ]×²
  [[nodiscard]] Mat3 series(int k) const;
  /// Hessian in φ of E : (I + c_k [φ]× + c_{k+1} [φ]×²)
  [[nodiscard]] Mat3 hessian(int k, const Mat3& E) const;
  /// dc_k/dx and d²c_k/dx²
  [[nodiscard]] double first(int k) const { return -0.5 * (c_[k + 1] - k * c_[k + 2]); }
  [[nodiscard]] double second(int k) const {
    return 0.25 * (c_[k + 2] - (2 * k + 1) * c_[k + 3] + k * (k + 2) * c_[k + 4]);
  }

  Vec3 phi_;
  double x_;  ///< |φ|²
  std::array<double, 8> c_;
  int chord_;  ///< C = I + c_k [φ]× + c_{k+1} [φ]×², this is k
};

}  // namespace stylet::beam

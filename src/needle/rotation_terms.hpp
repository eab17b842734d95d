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

/// Stumpff functions c_k(x) = Σ_j (-x)^j / (2j + k)!, k = 0…7, x ≥ 0, for example c_1 = sin θ / θ with x = θ². Accurate
/// to rounding for any x, also near zero. (Stumpff 1959.)
[[nodiscard]] std::array<double, 8> stumpff(double x);

/// The first six of them, k = 0…5, which first derivatives need. Takes few operations where an element is bent by less
/// than 0.2 rad.
[[nodiscard]] inline std::array<double, 6> first_stumpff(double x) {
  constexpr double small = 0.04;  // for smaller x, the error of five terms of c_4 and c_5 is below rounding
  if (!(x < small)) {
    const std::array<double, 8> c = stumpff(x);
    return {c[0], c[1], c[2], c[3], c[4], c[5]};
  }
  const double xx = x * x;
  const double fourth =
      (1.0 / 24 - x * (1.0 / 720)) + xx * ((1.0 / 40320 - x * (1.0 / 3628800)) + xx * (1.0 / 479001600));
  const double fifth =
      (1.0 / 120 - x * (1.0 / 5040)) + xx * ((1.0 / 362880 - x * (1.0 / 39916800)) + xx * (1.0 / 6227020800));
  // x c_{k+2} = 1/k! - c_k
  const double third = 1.0 / 6 - x * fifth;
  const double second = 0.5 - x * fourth;
  return {1.0 - x * second, 1.0 - x * third, second, third, fourth, fifth};
}

/// Shape of the centreline in an element that turns the frame by a rotation vector.
enum class ElementKind {
  arc,  ///< the rotation is spread evenly: a piece of a circular helix
  rod,  ///< a joint at the element's start has all of the rotation; a straight rod follows
};

/// Functions of an element's rotation vector φ [rad] (s κ for an arc up to s) and their derivatives:
///   exp([φ]×) = I + c_1 [φ]× + c_2 [φ]×²,    V(φ) = ∫₀¹ exp(σ[φ]×) dσ = I + c_2 [φ]× + c_3 [φ]×².
/// V is also the left Jacobian of SO(3): exp([φ + δ]×) = exp([V δ]×) exp([φ]×) + O(δ²). The chord of the element / its
/// length, in the frame of its start, is C(φ) e_z, with C = V for an arc and C = exp for a rod.
class RotationTerms {
 public:
  explicit RotationTerms(const Vec3& phi, ElementKind kind = ElementKind::arc)
      : phi_(phi), x_(phi.squaredNorm()), c_(first_stumpff(x_)), chord_(kind == ElementKind::arc ? 2 : 1) {}

  /// exp([φ]×)
  [[nodiscard]] Mat3 rotation() const { return series(1); }
  /// V(φ)
  [[nodiscard]] Mat3 mean_rotation() const { return series(2); }
  /// exp([φ]×) e_z
  [[nodiscard]] Vec3 tangent() const { return series_z(1); }
  /// C(φ) e_z
  [[nodiscard]] Vec3 chord() const { return series_z(chord_); }
  /// ∂(C(φ) e_z)/∂φ
  [[nodiscard]] Mat3 chord_derivative() const;
  /// Hessian in φ of E : exp([φ]×)
  [[nodiscard]] Mat3 rotation_hessian(const Mat3& E) const { return hessian(1, E); }
  /// Hessian in φ of a · C(φ) e_z
  [[nodiscard]] Mat3 chord_hessian(const Vec3& a) const { return hessian(chord_, a * Vec3::UnitZ().transpose()); }

 private:
  /// I + c_k [φ]× + c_{k+1} [φ]×²
  [[nodiscard]] Mat3 series(int k) const;
  /// Last column of series(k).
  [[nodiscard]] Vec3 series_z(int k) const;
  /// Hessian in φ of E : (I + c_k [φ]× + c_{k+1} [φ]×²)
  [[nodiscard]] Mat3 hessian(int k, const Mat3& E) const;
  /// dc_k/dx
  [[nodiscard]] double first(int k) const { return -0.5 * (c_[k + 1] - k * c_[k + 2]); }

  Vec3 phi_;
  double x_;  ///< |φ|²
  std::array<double, 6> c_;
  int chord_;  ///< the k in C = I + c_k [φ]× + c_{k+1} [φ]×²
};

inline Mat3 RotationTerms::series(int k) const {
  const double a = c_[k];
  const double b = c_[k + 1];
  const double xy = b * phi_.x() * phi_.y();
  const double yz = b * phi_.y() * phi_.z();
  const double zx = b * phi_.z() * phi_.x();
  const Vec3 squares = b * phi_.cwiseAbs2();
  const Vec3 turn = a * phi_;
  Mat3 m;
  m << 1.0 - (squares.y() + squares.z()), xy - turn.z(), zx + turn.y(),  //
      xy + turn.z(), 1.0 - (squares.z() + squares.x()), yz - turn.x(),   //
      zx - turn.y(), yz + turn.x(), 1.0 - (squares.x() + squares.y());
  return m;
}

inline Vec3 RotationTerms::series_z(int k) const {
  const double a = c_[k];
  const double along = c_[k + 1] * phi_.z();
  return {along * phi_.x() + a * phi_.y(), along * phi_.y() - a * phi_.x(),
          1.0 - c_[k + 1] * (phi_.x() * phi_.x() + phi_.y() * phi_.y())};
}

inline Mat3 RotationTerms::chord_derivative() const {
  // C e_z = e_z + a φ × e_z + b (φ φ_z - x e_z) with a = c_k(x) and b = c_{k+1}(x).
  const double a = c_[chord_];
  const double b = c_[chord_ + 1];
  const double by_a = 2.0 * first(chord_);
  const double by_b = 2.0 * first(chord_ + 1);
  const double z = phi_.z();
  const Vec3 by_x(by_a * phi_.y() + by_b * z * phi_.x(), by_b * z * phi_.y() - by_a * phi_.x(),
                  by_b * (z * z - x_) - 2.0 * b);
  Mat3 m = by_x * phi_.transpose();
  m(0, 0) += b * z;
  m(1, 1) += b * z;
  m(0, 1) += a;
  m(1, 0) -= a;
  m(0, 2) += b * phi_.x();
  m(1, 2) += b * phi_.y();
  m(2, 2) += 2.0 * b * z;
  return m;
}

}  // namespace stylet::beam

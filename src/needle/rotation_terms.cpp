// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/rotation_terms.hpp"

#include <cmath>

namespace stylet::beam {

namespace {

/// Number of terms after which the rest of the series of c_6 is below rounding: kTerms if x < 4, and kFewTerms if
/// x < kSmall, which is an element bent by 0.2 rad.
constexpr int kTerms = 12;
constexpr int kFewTerms = 4;
constexpr double kSmall = 0.04;

/// 1/((i + 6)(i + 5)): ratio of term j to the term before it, with i = 2j in the series of c_6 and i = 2j + 1 in that
/// of c_7.
constexpr auto kRatio = [] {
  std::array<double, 2 * kTerms + 2> ratio{};
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    const double n = static_cast<double>(i) + 6.0;
    ratio[i] = 1.0 / (n * (n - 1.0));
  }
  return ratio;
}();

}  // namespace

std::array<double, 8> stumpff(double x) {
  static constexpr std::array<double, 6> inverse_factorial = {1.0, 1.0, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120};
  std::array<double, 8> c{};
  // Recursion x c_{k+2} = 1/k! - c_k: downwards from the series where x is small, upwards from the circular functions
  // where x is large. In each case the direction that damps rounding errors.
  if (x < 4.0) {
    const int terms = x < kSmall ? kFewTerms : kTerms;
    double sixth = 1.0;
    double seventh = 1.0;
    for (int j = terms; j >= 1; --j) {
      sixth = 1.0 - x * kRatio[static_cast<std::size_t>(2 * j)] * sixth;
      seventh = 1.0 - x * kRatio[static_cast<std::size_t>(2 * j + 1)] * seventh;
    }
    c[6] = sixth / 720.0;
    c[7] = seventh / 5040.0;
    for (int k = 5; k >= 0; --k) c[k] = inverse_factorial[k] - x * c[k + 2];
  } else {
    const double theta = std::sqrt(x);
    c[0] = std::cos(theta);
    c[1] = std::sin(theta) / theta;
    for (int k = 2; k <= 7; ++k) c[k] = (inverse_factorial[k - 2] - c[k - 2]) / x;
  }
  return c;
}

Mat3 RotationTerms::hessian(int k, const Mat3& E) const {
  // E : (I + a [φ]× + b [φ]×²) = tr E + a(x) v·φ + b(x) φᵀSφ,  S = sym E - tr E I.
  const std::array<double, 8> c = stumpff(x_);
  const auto second = [&c](int i) {  // d²c_i/dx²
    return 0.25 * (c[i + 2] - (2 * i + 1) * c[i + 3] + i * (i + 2) * c[i + 4]);
  };
  const Vec3 v(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
  Mat3 S = 0.5 * (E + E.transpose());
  S.diagonal().array() -= E.trace();
  const Vec3 Sphi = S * phi_;
  const double p = v.dot(phi_);
  const double q = phi_.dot(Sphi);
  const Vec3 mixed = 2.0 * first(k) * v + 4.0 * first(k + 1) * Sphi;
  const double along = 4.0 * (second(k) * p + second(k + 1) * q);
  Mat3 h = 2.0 * c_[k + 1] * S + (mixed + along * phi_) * phi_.transpose() + phi_ * mixed.transpose();
  h.diagonal().array() += 2.0 * (first(k) * p + first(k + 1) * q);
  return h;
}

}  // namespace stylet::beam

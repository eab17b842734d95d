// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/kelvinlet.hpp"

#include <cmath>
#include <numbers>

namespace stylet {

namespace {

/// The two constants of the kernel [mm²/N].
struct Constants {
  double a;
  double b;
};
Constants constants(const Medium& medium) {
  const double a = 1.0 / (4.0 * std::numbers::pi * medium.mu);
  return {a, a / (4.0 * (1.0 - medium.poisson))};
}

/// Integrals of 1/r, 1/r³, τ/r³ and τ²/r³ over the lag τ, with r = √(τ² + m²).
struct Lags {
  double inverse = 0.0;
  double cube = 0.0;
  double first = 0.0;
  double second = 0.0;

  Lags& add(double sign, const Lags& other) {
    inverse += sign * other.inverse;
    cube += sign * other.cube;
    first += sign * other.first;
    second += sign * other.second;
    return *this;
  }
};

/// The integrals from one τ to a larger one.
Lags from_to(double from, double to, double m) {
  const double r_from = std::sqrt(from * from + m * m);
  const double r_to = std::sqrt(to * to + m * m);
  // asinh(to / m) − asinh(from / m) as one logarithm of sums, which avoids cancellation: (r − τ)(r + τ) = m².
  const double above = from >= 0.0 ? (to + r_to) / (from + r_from)
                       : to <= 0.0 ? (r_from - from) / (r_to - to)
                                   : (to + r_to) * (r_from - from) / (m * m);
  const double arc = std::log(above);
  const double slope = to / r_to - from / r_from;
  return {arc, slope / (m * m), 1.0 / r_from - 1.0 / r_to, arc - slope};
}

/// The second antiderivatives.
Lags twice(double tau, double m) {
  const double r = std::sqrt(tau * tau + m * m);
  const double arc = std::asinh(tau / m);
  return {tau * arc - r, r / (m * m), -arc, tau * arc - 2.0 * r};
}

/// Means over two parallel pieces, of lengths one ≥ two, whose centres are τ apart along them.
Lags mean(double tau, double m, double one, double two) {
  Lags sum;
  if (one == 0.0) {
    const double r = std::sqrt(tau * tau + m * m);
    const double cube = 1.0 / (r * r * r);
    return {1.0 / r, cube, tau * cube, tau * tau * cube};
  }
  if (two == 0.0) {
    sum = from_to(tau - 0.5 * one, tau + 0.5 * one, m);
    const double share = 1.0 / one;
    return {share * sum.inverse, share * sum.cube, share * sum.first, share * sum.second};
  }
  const double far = 0.5 * (one + two);
  const double near = 0.5 * (one - two);
  sum.add(1.0, twice(tau + far, m)).add(-1.0, twice(tau + near, m));
  sum.add(-1.0, twice(tau - near, m)).add(1.0, twice(tau - far, m));
  const double share = 1.0 / (one * two);
  return {share * sum.inverse, share * sum.cube, share * sum.first, share * sum.second};
}

}  // namespace

Mat3 kelvinlet(const Vec3& r, double epsilon, const Medium& medium) {
  const auto [a, b] = constants(medium);
  const double inverse = 1.0 / std::sqrt(r.squaredNorm() + epsilon * epsilon);
  const double cube = inverse * inverse * inverse;
  Mat3 G = (b * cube) * r * r.transpose();
  G.diagonal().array() += (a - b) * inverse + 0.5 * a * epsilon * epsilon * cube;
  return G;
}

Mat3 kelvinlet(const Segment& at, const Segment& on, const Vec3& direction, double epsilon, const Medium& medium) {
  const auto [a, b] = constants(medium);
  const Vec3 between = at.centre - on.centre;
  const double tau = direction.dot(between);
  const Vec3 across = between - tau * direction;
  const double m = std::sqrt(across.squaredNorm() + epsilon * epsilon);
  const Lags I = mean(tau, m, std::max(at.length, on.length), std::min(at.length, on.length));
  const Vec3 by_across = b * (I.cube * across + I.first * direction);
  const Vec3 by_direction = b * (I.first * across + I.second * direction);
  Mat3 G = by_across * across.transpose() + by_direction * direction.transpose();
  G.diagonal().array() += (a - b) * I.inverse + 0.5 * a * epsilon * epsilon * I.cube;
  return G;
}

double kelvinlet_self(const Medium& medium) {
  const auto [a, b] = constants(medium);
  return 1.5 * a - b;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/kelvinlet.hpp"

#include <cmath>
#include <numbers>

namespace stylet {

namespace {

/// The kernel's two constants [mm²/N].
struct Constants {
  double a;
  double b;
};
Constants constants(const Medium& medium) {
  const double a = 1.0 / (4.0 * std::numbers::pi * medium.mu);
  return {a, a / (4.0 * (1.0 - medium.poisson))};
}

/// Four integrals over the lag τ, with r = √(τ² + m²): of 1/r, 1/r³, τ/r³, τ²/r³.
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

/// Antiderivatives in τ.
Lags once(double tau, double m) {
  const double r = std::hypot(tau, m);
  const double arc = std::asinh(tau / m);
  return {arc, tau / (m * m * r), -1.0 / r, arc - tau / r};
}

/// Antiderivatives of these.
Lags twice(double tau, double m) {
  const double r = std::hypot(tau, m);
  const double arc = std::asinh(tau / m);
  return {tau * arc - r, r / (m * m), -arc, tau * arc - 2.0 * r};
}

/// Means over two parallel pieces of lengths one ≥ two whose centres lie τ apart along them.
Lags mean(double tau, double m, double one, double two) {
  Lags sum;
  if (one == 0.0) {
    const double r = std::hypot(tau, m);
    const double cube = 1.0 / (r * r * r);
    return {1.0 / r, cube, tau * cube, tau * tau * cube};
  }
  if (two == 0.0) {
    sum.add(1.0, once(tau + 0.5 * one, m)).add(-1.0, once(tau - 0.5 * one, m));
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
  const Mat3 mixed = across * direction.transpose();
  Mat3 G = b * (I.cube * across * across.transpose() + I.first * (mixed + mixed.transpose()) +
                I.second * direction * direction.transpose());
  G.diagonal().array() += (a - b) * I.inverse + 0.5 * a * epsilon * epsilon * I.cube;
  return G;
}

double kelvinlet_self(const Medium& medium) {
  const auto [a, b] = constants(medium);
  return 1.5 * a - b;
}

}  // namespace stylet

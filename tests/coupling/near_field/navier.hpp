// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"

namespace stylet::test {

/// ∂u/∂x by central differences.
template <class Field>
Mat3 gradient(const Field& u, const Vec3& x, double h = 1e-4) {
  Mat3 result;
  for (int k = 0; k < 3; ++k) result.col(k) = (u(x + h * Vec3::Unit(k)) - u(x - h * Vec3::Unit(k))) / (2.0 * h);
  return result;
}

/// Cauchy stress of a displacement field [MPa].
template <class Field>
Mat3 stress(const Field& u, const Vec3& x, const Medium& medium) {
  const Mat3 F = gradient(u, x);
  const double lambda = 2.0 * medium.mu * medium.poisson / (1.0 - 2.0 * medium.poisson);
  return lambda * F.trace() * Mat3::Identity() + medium.mu * (F + F.transpose());
}

/// The body force that balances the stress of a displacement field: −div σ [N/mm³].
template <class Field>
Vec3 body_force(const Field& u, const Vec3& x, const Medium& medium) {
  constexpr double h = 1e-2;
  Vec3 divergence = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 way = h * Vec3::Unit(k);
    divergence += (stress(u, x + way, medium).col(k) - stress(u, x - way, medium).col(k)) / (2.0 * h);
  }
  return -divergence;
}

}  // namespace stylet::test

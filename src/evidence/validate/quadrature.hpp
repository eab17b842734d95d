// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet::validate {

/// A point of a quadrature rule on 0 … 1.
struct GaussPoint {
  double x;
  double weight;  ///< the weights add up to 1
};

/// The Gauss–Legendre rule with n points, exact for polynomials up to degree 2n − 1.
/// @param n number of points, ≥ 1
std::vector<GaussPoint> gauss_legendre(int n);

/// A point of a quadrature rule on a tetrahedron.
struct TetrahedronPoint {
  Vec4 weights;   ///< barycentric coordinates
  double factor;  ///< share of the volume; the shares add up to 1
};

/// Conical product of Gauss–Legendre rules with n points each: n³ points, exact for polynomials up to degree 2n − 3.
/// @param n ≥ 2
/// @cite Stroud1971
std::vector<TetrahedronPoint> tetrahedron_rule(int n);

}  // namespace stylet::validate

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

/// Closed solutions of bent beams, which needles are checked against.
namespace stylet {

/// Small deflection [mm] at s of a cantilever of bending stiffness EI [N mm²] under a lateral force [N] at a, clamped
/// at 0 (Euler–Bernoulli).
inline double cantilever_deflection(double force, double a, double s, double bending_stiffness) {
  const double near = std::min(s, a);
  const double far = std::max(s, a);
  return force * near * near * (3.0 * far - near) / (6.0 * bending_stiffness);
}

/// Cantilever under a dead end force P across its undeformed axis, by the slope at its tip [rad]. K. E. Bisshopp and
/// D. C. Drucker, Large deflection of cantilever beams, Q. Appl. Math. 3 (1945) 272–275.
struct Elastica {
  double force;       ///< [N]
  double deflection;  ///< [mm] along the force
  double reach;       ///< [mm] along the undeformed axis

  Elastica(double tip_slope, double length, double bending_stiffness) {
    const double k = std::sqrt((1.0 + std::sin(tip_slope)) / 2.0);
    const double theta = std::asin(1.0 / (k * std::numbers::sqrt2));
    const double alpha = std::comp_ellint_1(k) - std::ellint_1(k, theta);
    force = alpha * alpha * bending_stiffness / (length * length);
    deflection = length * (1.0 - 2.0 / alpha * (std::comp_ellint_2(k) - std::ellint_2(k, theta)));
    reach = length * std::numbers::sqrt2 / alpha * std::sqrt(std::sin(tip_slope));
  }
};

}  // namespace stylet

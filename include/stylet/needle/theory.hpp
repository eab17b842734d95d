// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

/// Closed-form solutions of bent beams, with which the needle models are checked.
namespace stylet {

/// Deflection [mm] at s [mm] of a cantilever clamped at 0 under a lateral force [N] at a [mm], for small deflections
/// (Euler–Bernoulli). @param bending_stiffness EI [N mm²]
inline double cantilever_deflection(double force, double a, double s, double bending_stiffness) {
  const double near = std::min(s, a);
  const double far = std::max(s, a);
  return force * near * near * (3.0 * far - near) / (6.0 * bending_stiffness);
}

/// Large deflection of a cantilever under a force at its tip that stays perpendicular to the undeformed axis, as a
/// function of the slope at the tip [rad]. K. E. Bisshopp and D. C. Drucker, Large deflection of cantilever beams, Q.
/// Appl. Math. 3 (1945) 272–275.
struct Elastica {
  double force;       ///< [N] at the tip
  double deflection;  ///< [mm] of the tip, along the force
  double reach;       ///< [mm] position of the tip along the undeformed axis

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

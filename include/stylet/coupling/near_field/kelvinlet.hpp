// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet {

/// A homogeneous isotropic elastic medium.
struct Medium {
  double mu = 0.0;       ///< [MPa] shear modulus
  double poisson = 0.0;  ///< Poisson ratio
};

/// A straight piece of the needle, or a point of it.
struct Segment {
  Vec3 centre = Vec3::Zero();      ///< [mm] LPS, undeformed
  Vec3 direction = Vec3::UnitZ();  ///< unit vector
  double length = 0.0;             ///< [mm] 0: a point
};

/// Kelvinlet: displacement at y + r per unit force at y [mm/N], in an unbounded medium, with the force spread over the
/// regularisation radius ε:
///   G = (a−b)/r_ε I + b/r_ε³ r rᵀ + (a/2) ε²/r_ε³ I,   r_ε = √(r² + ε²),   a = 1/(4πμ),   b = a/(4(1−ν)).
/// @cite DeGoesJames2017 eq 6, @cite Cortez2001 for the same in a fluid
Mat3 kelvinlet(const Vec3& r, double epsilon, const Medium& medium);

/// G averaged over two pieces of the needle, which are taken as parallel to `direction`: the force is uniform over
/// `on`, the displacement is averaged over `at` [mm/N]. In closed form, because 1/r_ε, τ/r_ε³, τ²/r_ε³ and 1/r_ε³ have
/// second antiderivatives in the lag τ.
/// @param direction unit vector of both pieces
Mat3 kelvinlet(const Segment& at, const Segment& on, const Vec3& direction, double epsilon, const Medium& medium);

/// Mean of the diagonal of kelvinlet(0, ε) times ε [mm²/N]: (5−6ν) / (16πμ(1−ν)).
double kelvinlet_self(const Medium& medium);

}  // namespace stylet

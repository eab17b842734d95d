// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/tenting.hpp"

#include "stylet/fem/material.hpp"

#include "stylet/coupling/near_field/needle_kernel.hpp"
#include "stylet/coupling/tip_dent.hpp"

#include <fmt/format.h>

namespace stylet {

namespace {

constexpr double kTentingMin_mm = 3.0;   ///< smallest plausible tenting
constexpr double kTentingMax_mm = 20.0;  ///< largest plausible tenting
constexpr double kLagMax_mm = 5.0;       ///< largest plausible cutting lag

/// Displacement [mm] of tissue under a force on the tip: a linear part on the scale of organs and a dent on the scale
/// of the needle, which stiffens.
double pressed_mm(const TissueParameters& t, double force_N, double needle_diameter_mm, const NearSurface& skin) {
  const Material material{t.young_kPa * 1e-3, t.poisson};
  const Medium medium{material.mu(), t.poisson};
  const NeedleKernel needle{.radius_mm = 0.5 * needle_diameter_mm};
  const auto moves = [&](double epsilon) {
    return skin.inwards.dot(tip_kernel(skin, {}, epsilon, medium) * skin.inwards);
  };
  const double organs = moves(NeedleKernel::kScale_mm);
  const double dent = moves(needle.own_tip_epsilon(skin, {}, t.poisson)) - organs;
  return organs * force_N + DentLaw{dent, t.stiffening * material.young_MPa}.depth(force_N);
}

}  // namespace

double tenting_mm(const TissueParameters& t, double force_N, double needle_diameter_mm) {
  return pressed_mm(t, force_N, needle_diameter_mm, {.depth = 0.0, .share = 1.0});
}

double cutting_lag_mm(const TissueParameters& t, double force_N, double needle_diameter_mm) {
  return pressed_mm(t, force_N, needle_diameter_mm, {});
}

std::vector<std::string> tenting_warnings(const std::string& region, const TissueParameters& t,
                                          double needle_diameter_mm) {
  std::vector<std::string> warnings;
  const std::string stiffening = t.stiffening > 0.0 ? fmt::format(" and stiffening = {:g}", t.stiffening) : "";
  const double tenting = tenting_mm(t, t.puncture_N, needle_diameter_mm);
  if (t.puncture_N > 0.0 && (tenting < kTentingMin_mm || tenting > kTentingMax_mm)) {
    warnings.push_back(fmt::format(
        "tissue.{}: puncture_N = {:g} with young_kPa = {:g}{} means {:.1f} mm of tenting before the surface "
        "breaks; {:g} to {:g} mm is plausible. Change them together.",
        region, t.puncture_N, t.young_kPa, stiffening, tenting, kTentingMin_mm, kTentingMax_mm));
  }
  const double lag = cutting_lag_mm(t, t.cutting_N, needle_diameter_mm);
  if (lag > kLagMax_mm) {
    warnings.push_back(fmt::format(
        "tissue.{}: cutting_N = {:g} with young_kPa = {:g}{} means a cutting lag of {:.1f} mm: the tip cuts that far "
        "behind the place to which it is pushed; at most {:g} mm is plausible. Change them together.",
        region, t.cutting_N, t.young_kPa, stiffening, lag, kLagMax_mm));
  }
  return warnings;
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/tip_dent.hpp"

#include <cmath>

namespace stylet {

namespace {
/// √(1 + 4 k₂ F / k₁²)
double root(const DentLaw& law, double force) {
  return std::sqrt(1.0 + 4.0 * law.stiffening_MPa * law.compliance * law.compliance * force);
}
}  // namespace

double DentLaw::depth(double force) const { return 2.0 * compliance * force / (1.0 + root(*this, force)); }

double DentLaw::slope(double force) const { return compliance / root(*this, force); }

double DentLaw::complementary_energy(double force) const {
  // F z minus the energy in the dent, with F written as k₁ z + k₂ z².
  const double z = depth(force);
  return compliance > 0.0 ? z * z * (0.5 / compliance + 2.0 / 3.0 * stiffening_MPa * z) : 0.0;
}

double DentLaw::compliance_for(double force, double depth, double stiffening_MPa) {
  return depth / (force - stiffening_MPa * depth * depth);
}

TipDent::Under TipDent::under(const Vec3& force) const {
  Under result{.linear = force};
  const Vec3 dent = compliance * force;
  const double twice_energy = force.dot(dent);
  result.complementary_energy_Nmm = 0.5 * twice_energy;
  if (stiffening_MPa <= 0.0 || !(twice_energy > 0.0)) return result;
  const DentLaw law{compliance.trace() / 3.0, stiffening_MPa};
  const double q = std::sqrt(twice_energy / law.compliance);  // [N] the magnitude of the force where C is isotropic
  const double share = law.depth(q) / (law.compliance * q);
  const double along = (law.slope(q) / law.compliance - share) / twice_energy;
  result.linear = share * force;
  result.slope = share * Mat3::Identity() + along * force * dent.transpose();
  result.complementary_energy_Nmm = law.complementary_energy(q);
  return result;
}

}  // namespace stylet

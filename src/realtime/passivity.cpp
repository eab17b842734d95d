// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/passivity.hpp"

#include <algorithm>

namespace stylet {

void PassivityControl::observe(const Wrench& sent, const Vec3& moved, const Vec3& turned) {
  energy_ = std::min(energy_ - sent.force.dot(moved) - sent.torque.dot(turned), settings_.credit_Nmm);
  lowest_ = std::min(lowest_, energy_);
}

Wrench PassivityControl::control(const Wrench& on_hand, const Twist& handle, double dt) {
  if (energy_ >= 0.0 || settings_.max_damping_N_s_per_mm <= 0.0) return on_hand;
  const double lever2 = settings_.lever_mm * settings_.lever_mm;
  const double square = handle.velocity.squaredNorm() + lever2 * handle.angular_velocity.squaredNorm();
  if (!(square > 0.0)) return on_hand;  // a handle at rest exchanges no energy; the excess is dissipated when it moves
  ++active_;
  double alpha = -energy_ / (dt * square);
  if (alpha > settings_.max_damping_N_s_per_mm) {
    alpha = settings_.max_damping_N_s_per_mm;
    ++limited_;
  }
  return {on_hand.force - alpha * handle.velocity, on_hand.torque - alpha * lever2 * handle.angular_velocity};
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/virtual_coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// The spare damping b − K T/2 − B; an error if it is not positive.
Result<double> spare(const char* motion, const char* stiffness_unit, const char* damping_unit, double K, double B,
                     double b, double T, const std::string& device) {
  const std::string where = fmt::format("virtual coupling, {}", motion);
  if (!(std::isfinite(K) && K > 0.0))
    return input_error(where, fmt::format("a stiffness of {} {} is not above 0", K, stiffness_unit),
                       "Give a stiffness above 0");
  if (!(std::isfinite(B) && B >= 0.0))
    return input_error(where, fmt::format("a damping of {} {} is below 0", B, damping_unit),
                       "Give a damping of 0 or more");
  const double needed = 0.5 * K * T + B;
  if (b > needed) return b - needed;
  const std::string cure = b > B ? fmt::format("Use a stiffness below {:.4g} {}, less damping, or a shorter period",
                                               2.0 * (b - B) / T, stiffness_unit)
                                 : fmt::format(
                                       "Use a damping below the device's {:.4g} {} and a matching stiffness, or state "
                                       "the damping of the device if it has more",
                                       b, damping_unit);
  return input_error(where,
                     fmt::format("a stiffness of {:.4g} {} and a damping of {:.4g} {} at a period of {:.4g} ms need a "
                                 "device damped by more than K T/2 + B = {:.4g} {}; {} has {:.4g}",
                                 K, stiffness_unit, B, damping_unit, 1e3 * T, needed, damping_unit,
                                 device.empty() ? "the device" : device, b),
                     cure);
}

}  // namespace

Result<VirtualCoupling> VirtualCoupling::create(const VirtualCouplingSettings& s, const DeviceTraits& device,
                                                double period_s) {
  if (!(std::isfinite(period_s) && period_s > 0.0))
    return input_error("virtual coupling, period", fmt::format("{} s is not above 0", period_s),
                       "Give a period above 0");
  const auto along = spare("translation", "N/mm", "N s/mm", s.stiffness_N_per_mm, s.damping_N_s_per_mm,
                           device.damping_N_s_per_mm, period_s, device.name);
  if (!along) return along.error();
  const VirtualCoupling without_torque(s, *along);
  // A device without torques exchanges no rotational energy, so only the signs of the rotational settings are checked.
  const double unlimited = 1e300;
  const auto around = spare("rotation", "N mm/rad", "N mm s/rad", s.stiffness_Nmm_per_rad, s.damping_Nmm_s_per_rad,
                            device.torque ? device.damping_Nmm_s_per_rad : unlimited, period_s, device.name);
  if (!around) return around.error();
  const double lever = without_torque.lever_mm();
  return VirtualCoupling(s, std::min(*along, *around / (lever * lever)));
}

double VirtualCoupling::lever_mm() const {
  return std::sqrt(settings_.stiffness_Nmm_per_rad / settings_.stiffness_N_per_mm);
}

Wrench VirtualCoupling::on_base(const Pose& device, const Twist& device_twist, const Pose& base,
                                const Twist& base_twist) const {
  Wrench w;
  w.force = settings_.stiffness_N_per_mm * (device.origin - base.origin) +
            settings_.damping_N_s_per_mm * (device_twist.velocity - base_twist.velocity);
  w.torque = settings_.stiffness_Nmm_per_rad * rotation_between(base.rotation, device.rotation) +
             settings_.damping_Nmm_s_per_rad * (device_twist.angular_velocity - base_twist.angular_velocity);
  return w;
}

}  // namespace stylet

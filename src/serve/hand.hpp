// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/realtime/latest_value.hpp"
#include "stylet/sim/model.hpp"

#include <memory>

namespace stylet::serve {

/// The pose of the base that a hand at a page asks for, relative to the entry point of a planned insertion.
struct HandTarget {
  double depth_mm = 0.0;           ///< as Step::base_depth_mm
  double speed_mm_per_s = 20.0;    ///< speed at which the base moves there
  double roll_deg = 0.0;           ///< about the axis, from local x to local y
  double tilt_left_deg = 0.0;      ///< tilt of the hub towards the patient's left
  double tilt_anterior_deg = 0.0;  ///< tilt of the hub towards anterior
  bool rest = false;               ///< the base stays where it is; the other fields are ignored
};

/// The limits of the motion of a hand at a page.
struct HandLimits {
  double depth_mm = 0.0;                     ///< largest depth
  static constexpr double behind_mm = 30.0;  ///< largest distance in front of the skin
  static constexpr double speed_mm_per_s = 200.0;
  static constexpr double tilt_deg = 10.0;
  static constexpr double turn_deg_per_s = 90.0;  ///< rate of roll
  static constexpr double tilt_deg_per_s = 20.0;
};
HandLimits hand_limits(const Scenario& scenario);

/// The pose of the base that belongs to a target of the hand.
/// @param plan gives the entry point and the direction
Pose hand_pose(const HandTarget& hand, const PlannedInsertion& plan, double needle_length_mm);
/// The roll and tilts of any pose of the base: the inverse of hand_pose() for its orientation. Other fields are
/// default.
/// @return the roll in −180…180 degrees; zero tilts where the base points backwards
HandTarget hand_angles(const Pose& base, const PlannedInsertion& plan);

/// A mouse, keyboard or gamepad at a page as a device. In simulated time the base moves from where it is to the newest
/// target, at the target's speed but within the limits. So a page that sends sixty targets per second gives a smooth
/// motion, and a pause stops it.
class PageDevice final : public Device {
 public:
  PageDevice(const PlannedInsertion& plan, const Scenario& scenario);

  [[nodiscard]] DeviceTraits traits() const override { return {.name = "page"}; }
  DeviceInput read(const DeviceTime& time) noexcept override;
  void write(const Wrench& /*on_hand*/) noexcept override {}

  /// Sets the target. Call it from one thread only, the thread that receives the page's messages.
  void aim(const HandTarget& target) { target_.write(target); }
  /// Where the base is. Call it from one thread only, the thread that makes pictures.
  [[nodiscard]] const HandTarget& place() {
    shown_.fetch();
    return shown_.value();
  }

 private:
  PlannedInsertion plan_;
  double needle_length_mm_;
  HandLimits limits_;
  HandTarget now_;
  double last_s_ = 0.0;  ///< simulated time of the last read()
  LatestValue<HandTarget> target_;
  LatestValue<HandTarget> shown_;
};

/// Gives a RealtimeRunner, which owns its device, a device that is also used elsewhere.
class SharedDevice final : public Device {
 public:
  explicit SharedDevice(std::shared_ptr<Device> device) : device_(std::move(device)) {}
  [[nodiscard]] DeviceTraits traits() const override { return device_->traits(); }
  DeviceInput read(const DeviceTime& time) noexcept override { return device_->read(time); }
  void write(const Wrench& on_hand) noexcept override { device_->write(on_hand); }

 private:
  std::shared_ptr<Device> device_;
};

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/realtime/latest_value.hpp"
#include "stylet/sim/model.hpp"

#include <memory>

namespace stylet::serve {

/// Where a hand at a page wants the needle's base: about the skin point of a planned insertion.
struct HandTarget {
  double depth_mm = 0.0;           ///< as Step::base_depth_mm
  double speed_mm_per_s = 20.0;    ///< to get there with
  double roll_deg = 0.0;           ///< about the axis, from local x to local y
  double tilt_left_deg = 0.0;      ///< the hub towards the patient's left
  double tilt_anterior_deg = 0.0;  ///< the hub towards anterior
  bool rest = false;               ///< stay where the base is, whatever the rest says
};

/// How far a hand may go.
struct HandLimits {
  double depth_mm = 0.0;    ///< deepest
  double behind_mm = 30.0;  ///< furthest before the skin
  double speed_mm_per_s = 200.0;
  double tilt_deg = 10.0;
  double turn_deg_per_s = 90.0;  ///< roll
  double tilt_deg_per_s = 20.0;
};
HandLimits hand_limits(const Scenario& scenario);

/// The pose of the base for a place of the hand.
/// @param plan its skin point and direction
Pose hand_pose(const HandTarget& hand, const PlannedInsertion& plan, double needle_length_mm);
/// Roll and tilts of a base that is anywhere: those of the place whose pose has this orientation.
/// @return the roll in −180…180 degrees; no tilt where the base points back
HandTarget hand_angles(const Pose& base, const PlannedInsertion& plan);

/// A mouse, keyboard or gamepad at a page, seen as a device: it goes from where it is to the newest target, no faster
/// than that asks for and the limits allow, in simulated time. So a page that sends sixty targets a second makes a
/// motion without steps, and a pause stops it.
class PageDevice final : public Device {
 public:
  PageDevice(const PlannedInsertion& plan, const Scenario& scenario);

  [[nodiscard]] DeviceTraits traits() const override { return {.name = "page"}; }
  DeviceInput read(const DeviceTime& time) noexcept override;
  void write(const Wrench& /*on_hand*/) noexcept override {}

  /// From the one thread that hears the page.
  void aim(const HandTarget& target) { target_.write(target); }
  /// Where it is now, for the one thread that shows it.
  [[nodiscard]] const HandTarget& place() {
    shown_.fetch();
    return shown_.value();
  }

 private:
  PlannedInsertion plan_;
  double needle_length_mm_;
  HandLimits limits_;
  HandTarget now_;
  double last_s_ = 0.0;  ///< simulated
  LatestValue<HandTarget> target_;
  LatestValue<HandTarget> shown_;
};

/// A device that somebody else keeps as well.
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

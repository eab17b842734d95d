// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"

#include <atomic>
#include <memory>
#include <optional>

namespace stylet::serve {

/// A handle that can take the needle up only where the needle is. A pose of the handle is accepted if it is near the
/// last accepted one, at first near the start of the needle. So the needle does not jump through the patient when an
/// insertion starts, a pause ends or the handle is tracked again while the handle is somewhere else.
class PickUp final : public Device {
 public:
  static constexpr double kNear_mm = 20.0;   ///< largest distance between the base points
  static constexpr double kNear_deg = 20.0;  ///< largest angle between the axes; the roll may be any

  /// @param start pose of the base at the start
  PickUp(std::unique_ptr<Device> handle, const Pose& start) : handle_(std::move(handle)), last_(start) {}

  [[nodiscard]] DeviceTraits traits() const override { return handle_->traits(); }
  DeviceInput read(const DeviceTime& time) noexcept override;
  void write(const Wrench& on_hand) noexcept override { handle_->write(on_hand); }

  /// How far a tracked handle is from where it has to be.
  struct Away {
    double mm = 0.0;
    double deg = 0.0;
  };
  /// May be called from any thread. @return empty if the handle moves the needle, or gives no valid pose
  [[nodiscard]] std::optional<Away> away() const;

 private:
  std::unique_ptr<Device> handle_;
  Pose last_;            ///< last accepted pose of the handle
  double last_s_ = 0.0;  ///< simulated time of the last read()
  std::atomic<bool> is_away_ = false;
  std::atomic<double> away_mm_ = 0.0;
  std::atomic<double> away_deg_ = 0.0;
};

}  // namespace stylet::serve

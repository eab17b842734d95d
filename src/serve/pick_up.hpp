// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"

#include <atomic>
#include <memory>
#include <optional>

namespace stylet::serve {

/// A handle that takes the needle up where the needle is, and nowhere else: a pose counts if it is near the last one
/// that did, at first near the needle's start. So a needle does not tear through the patient to a handle that is
/// somewhere else when an insertion starts, a pause ends or the handle is found again.
class PickUp final : public Device {
 public:
  static constexpr double kNear_mm = 20.0;   ///< between the base points
  static constexpr double kNear_deg = 20.0;  ///< between the axes; a needle may be taken up with any roll

  /// @param start of the base
  PickUp(std::unique_ptr<Device> handle, const Pose& start) : handle_(std::move(handle)), last_(start) {}

  [[nodiscard]] DeviceTraits traits() const override { return handle_->traits(); }
  DeviceInput read(const DeviceTime& time) noexcept override;
  void write(const Wrench& on_hand) noexcept override { handle_->write(on_hand); }

  /// How far a handle that says a pose is from where it has to be.
  struct Away {
    double mm = 0.0;
    double deg = 0.0;
  };
  /// Any thread. @return nothing where the needle is in hand, or the handle says no pose
  [[nodiscard]] std::optional<Away> away() const;

 private:
  std::unique_ptr<Device> handle_;
  Pose last_;            ///< of the handle, that counted
  double last_s_ = 0.0;  ///< simulated
  std::atomic<bool> is_away_ = false;
  std::atomic<double> away_mm_ = 0.0;
  std::atomic<double> away_deg_ = 0.0;
};

}  // namespace stylet::serve

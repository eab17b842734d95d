// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::measure {

/// A fixed amount of arithmetic. Its time varies only by disturbances on the machine. It uses processor registers only,
/// so it leaves the caches unchanged.
class FixedWork {
 public:
  /// @param about_us [µs] processor time that the work takes on this machine; calibrated here
  explicit FixedWork(double about_us);

  /// Does the work. @return its thread CPU time [µs]
  [[nodiscard]] double run() const;

 private:
  void work() const;
  long turns_ = 1000;
};

}  // namespace stylet::measure

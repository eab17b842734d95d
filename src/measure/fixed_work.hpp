// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::measure {

/// Arithmetic of always the same amount: what its time varies by is the machine's doing. It
/// stays within the processor's registers, so whoever comes after it finds the caches as they were.
class FixedWork {
 public:
  /// @param about_us [µs] of processor time, on this machine now
  explicit FixedWork(double about_us);

  /// @return [µs] processor time of the thread
  [[nodiscard]] double run() const;

 private:
  void work() const;
  long turns_ = 1000;
};

}  // namespace stylet::measure

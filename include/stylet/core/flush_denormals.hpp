// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Denormal numbers count as zero in this thread while it lives; the former mode comes back. FTZ and DAZ on x86,
/// FPCR.FZ on 64-bit ARM.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

  /// False on processors where this class does nothing.
  [[nodiscard]] static bool available();

 private:
  unsigned long before_ = 0;
};

}  // namespace stylet

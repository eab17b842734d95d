// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Makes the calling thread treat denormal numbers as zero while an object of this class exists. The destructor
/// restores the previous mode. Sets FTZ and DAZ on x86, FPCR.FZ on 64-bit ARM.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

  /// Whether this class has an effect on this processor.
  [[nodiscard]] static bool available();

 private:
  unsigned long before_ = 0;
};

}  // namespace stylet

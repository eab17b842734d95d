// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "echo_field.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// Everything in a picture besides echoes on the beam's axis: side lobes and reverberation (clutter), which is seen in
/// fluid, rings near the transducer, and the receiver's noise. All of it is fixed on the screen.
class UltrasoundArtefacts {
 public:
  UltrasoundArtefacts(int lines, int samples, std::uint32_t seed);

  void begin();
  /// Adds the artefacts of a sample to the power of all lines; samples in their order.
  /// @param power (lines) of the echoes; receives the result
  void add(int sample, double depth_mm, float* real, float* imaginary, float* power);

  /// Noise without unit (lines × samples, real and imaginary part), of mean power 1.
  [[nodiscard]] const std::vector<float>& pattern() const { return pattern_; }

 private:
  int lines_, samples_;
  std::vector<float> pattern_;    ///< line by line
  std::vector<float> rows_;       ///< the same, sample by sample: real parts of all lines, then imaginary parts
  std::vector<float> memory_;     ///< (lines) amplitude that still reverberates
  std::vector<float> amplitude_;  ///< (lines + 1) sums of amplitudes from the first line on
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "point_spread.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// Echoes of a picture as complex numbers by line and sample, before the beam's width is taken into account, and then
/// the power of the picture. Does not allocate after construction.
class EchoField {
 public:
  EchoField(int lines, int samples);

  void clear();
  /// Rows of a line (samples).
  [[nodiscard]] float* real(int line) { return &real_[at(line)]; }
  [[nodiscard]] float* imaginary(int line) { return &imaginary_[at(line)]; }

  /// Adds a point's echo whose place is between lines and samples. @param amplitude shared by four samples
  void add(double line, double sample, float amplitude, float phase_real, float phase_imaginary);

  /// Blurs by the beam; afterwards row() has the result.
  void blur(const PointSpread& spread);
  /// Results at a sample, for all lines.
  [[nodiscard]] float* row_real(int sample) { return &row_real_[row_at(sample)]; }
  [[nodiscard]] float* row_imaginary(int sample) { return &row_imaginary_[row_at(sample)]; }

 private:
  [[nodiscard]] std::size_t at(int line) const {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(samples_);
  }
  [[nodiscard]] std::size_t row_at(int sample) const {
    return static_cast<std::size_t>(sample) * static_cast<std::size_t>(lines_);
  }
  void blur_along(const std::vector<float>& lines, const PointSpread& spread, std::vector<float>& rows);
  void blur_across(const PointSpread& spread, std::vector<float>& rows);

  int lines_, samples_;
  std::vector<float> real_, imaginary_;          ///< (lines × samples)
  std::vector<float> row_real_, row_imaginary_;  ///< (samples × lines)
  std::vector<float> block_;                     ///< lines of a block, padded
  std::vector<float> padded_;                    ///< a row with its ends mirrored
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/ultrasound_scanner.hpp"

#include <vector>

namespace stylet {

/// The separable Gaussian point-spread function of a picture, as sums over samples and over lines. Weights of a sum add
/// up to 1.
class PointSpread {
 public:
  static constexpr int kMostLines = 24;    ///< half width of the widest sum over lines
  static constexpr int kMostSamples = 16;  ///< half width of the widest sum over samples

  PointSpread(const BeamProfile& profile, int samples);

  /// Follows the lines of a picture; does nothing when only their place has changed. Does not allocate.
  void follow(const UltrasoundBeams& beams);

  /// Half width of the sum over samples, and its weights from the middle outwards.
  [[nodiscard]] int axial_half() const { return axial_half_; }
  [[nodiscard]] const float* axial() const { return axial_.data(); }
  /// Half width of the sum over lines at a sample, and its weights from the middle outwards.
  [[nodiscard]] int lateral_half(int sample) const { return halves_[static_cast<std::size_t>(sample)]; }
  [[nodiscard]] const float* lateral(int sample) const {
    return &lateral_[static_cast<std::size_t>(sample) * (kMostLines + 1)];
  }
  /// Factor of the speckle lattice at a sample that makes the mean power of the result 1.
  [[nodiscard]] float noise_scale(int sample) const { return noise_[static_cast<std::size_t>(sample)]; }
  /// Width of a point's echo in lines: the sum over lines of its echo, divided by its largest value.
  [[nodiscard]] double width_in_lines(double depth_mm) const;

 private:
  BeamProfile profile_;
  UltrasoundBeams beams_;
  int axial_half_ = 0;
  std::vector<float> axial_, lateral_, noise_;
  std::vector<int> halves_;
};

}  // namespace stylet

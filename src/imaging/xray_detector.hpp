// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/imaging_settings.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stylet {

/// Turns the transmission of rays into what a detector shows: photons with their noise, blurred by the screen, as the
/// logarithm of the signal, and as grey values in a window that follows the exposure.
class XrayDetector {
 public:
  explicit XrayDetector(const FluoroscopySettings& settings);

  /// Computes the optical depth that the detector sees: −ln of its signal relative to its signal without a patient.
  /// Does not allocate.
  /// @param transmission (pixels²) share of the photons that come through, 0…1
  /// @param exposure number that distinguishes the noise of pictures; the same number gives the same noise
  void detect(std::span<const float> transmission, std::uint64_t exposure);

  /// Of the last detect() (pixels²).
  [[nodiscard]] std::span<const float> optical_depth() const { return depth_; }

  /// Makes grey values of optical depths: white where much comes through, black where little does. As the automatic
  /// exposure of a C-arm, the window follows a measuring field: a disc in the middle of the picture. Of its pixels
  /// behind the patient the brightest 3 percent become white and the darkest percent black. Does not allocate.
  /// @param pixels along a side @param depths (pixels²) @param shades (pixels²) overwritten
  static void shade(int pixels, std::span<const float> depths, std::span<std::uint8_t> shades);

 private:
  void count_photons(std::span<const float> transmission, std::uint64_t exposure);
  void blur();

  static constexpr std::size_t kQuantiles = 4096;
  int pixels_ = 0;
  double photons_ = 0.0;
  std::uint64_t random_ = 0;
  std::array<float, kQuantiles> normal_{};  ///< quantiles of the normal distribution
  std::vector<float> signal_;
  std::vector<float> depth_;
};

}  // namespace stylet

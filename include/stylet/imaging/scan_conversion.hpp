// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/grey_picture.hpp"
#include "stylet/imaging/ultrasound_scanner.hpp"

namespace stylet {

/// Turns pictures by lines and samples into rectangular pictures in millimetres, by linear interpolation: the probe at
/// the bottom, the direction of the middle line up. Places outside of the lines are black.
class ScanConversion {
 public:
  explicit ScanConversion(double mm_per_pixel = 0.2) : mm_per_pixel_(mm_per_pixel) {}

  /// @return valid until the next call. Allocates only when the lines lie differently to each other than before.
  const GreyPicture& convert(const PolarPicture& polar);

 private:
  struct Source {
    std::int32_t at = -1;  ///< sample of the lower line and depth, or -1: black
    float line = 0.0F, depth = 0.0F;
  };
  void prepare(const UltrasoundBeams& beams);

  double mm_per_pixel_;
  double left_mm_ = 0.0, top_mm_ = 0.0;  ///< of the first pixel, in the plane
  UltrasoundBeams beams_;
  std::vector<Source> sources_;
  GreyPicture picture_;
};

}  // namespace stylet

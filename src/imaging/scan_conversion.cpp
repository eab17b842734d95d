// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/scan_conversion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {

void ScanConversion::prepare(const UltrasoundBeams& beams) {
  if (!sources_.empty() && beams.sector == beams_.sector && beams.surface_mm == beams_.surface_mm &&
      beams.first == beams_.first && beams.step == beams_.step && beams.lines == beams_.lines &&
      beams.samples == beams_.samples && beams.sample_mm == beams_.sample_mm)
    return;
  beams_ = beams;
  const double depth = beams.sample_mm * (beams.samples - 1);
  double right = -beams.first, top = beams.surface_mm + depth, bottom = beams.surface_mm;
  if (beams.sector) {
    right = std::sin(std::min(right, 0.5 * std::numbers::pi)) * top;
    bottom = std::min(std::cos(std::min(-beams.first, std::numbers::pi)) * beams.surface_mm,
                      std::cos(std::min(-beams.first, std::numbers::pi)) * top);
  }
  left_mm_ = -right;
  top_mm_ = top;
  picture_.columns = static_cast<int>(std::ceil(2.0 * right / mm_per_pixel_)) + 1;
  picture_.rows = static_cast<int>(std::ceil((top - bottom) / mm_per_pixel_)) + 1;
  picture_.mm_per_pixel = mm_per_pixel_;
  const auto pixels = static_cast<std::size_t>(picture_.columns) * static_cast<std::size_t>(picture_.rows);
  picture_.pixels.assign(pixels, 0);
  sources_.assign(pixels, {});
  for (int row = 0; row < picture_.rows; ++row) {
    for (int column = 0; column < picture_.columns; ++column) {
      const BeamPoint at =
          beams.locate(Eigen::Vector2d(left_mm_ + column * mm_per_pixel_, top_mm_ - row * mm_per_pixel_));
      const double sample = at.depth_mm / beams.sample_mm;
      if (at.line < 0.0 || at.line > beams.lines - 1 || sample < 0.0 || sample > beams.samples - 1) continue;
      const int line = std::min(static_cast<int>(at.line), beams.lines - 2);
      const int near = std::min(static_cast<int>(sample), beams.samples - 2);
      sources_[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture_.columns) +
               static_cast<std::size_t>(column)] = {line * beams.samples + near, static_cast<float>(at.line - line),
                                                    static_cast<float>(sample - near)};
    }
  }
}

const GreyPicture& ScanConversion::convert(const PolarPicture& polar) {
  prepare(polar.beams);
  picture_.right = polar.beams.across;
  picture_.down = -polar.beams.ahead;
  picture_.corner_mm = polar.beams.origin_mm + left_mm_ * polar.beams.across + top_mm_ * polar.beams.ahead;
  const auto samples = static_cast<std::size_t>(polar.beams.samples);
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    const Source& source = sources_[k];
    if (source.at < 0) continue;
    const std::uint8_t* const near = &polar.grey[static_cast<std::size_t>(source.at)];
    const auto along = [&](const std::uint8_t* p) {
      return static_cast<float>(p[0]) + source.depth * static_cast<float>(p[1] - p[0]);
    };
    const float one = along(near), two = along(near + samples);
    const float rounded = one + source.line * (two - one) + 0.5F;
    picture_.pixels[k] = static_cast<std::uint8_t>(rounded);
  }
  return picture_;
}

}  // namespace stylet

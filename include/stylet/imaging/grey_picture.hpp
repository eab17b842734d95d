// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// A rectangular grey picture of a plane in the patient.
struct GreyPicture {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;  ///< (rows × columns) row by row from the top; 0 is black
  double mm_per_pixel = 0.0;         ///< of both sides
  Vec3 corner_mm = Vec3::Zero();     ///< LPS, centre of the first pixel, top left
  Vec3 right = Vec3::UnitX();        ///< unit vector in LPS along a row
  Vec3 down = Vec3::UnitY();         ///< unit vector in LPS along a column
  double time_s = 0.0;               ///< moment that the picture shows

  [[nodiscard]] std::uint8_t at(int row, int column) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
  /// The point in the patient at a position in the picture [mm] LPS. @param column, row in pixels; whole numbers are
  /// centres of pixels
  [[nodiscard]] Vec3 point_mm(double column, double row) const {
    return corner_mm + mm_per_pixel * (column * right + row * down);
  }
  /// The transform from (column, row, 0, 1) in pixels to LPS in mm (4 × 4). Its third column is the unit normal
  /// right × down.
  [[nodiscard]] Eigen::Matrix4d pixel_to_lps() const;
};

}  // namespace stylet

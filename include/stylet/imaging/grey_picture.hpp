// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// A picture of grey values and its place in the patient. The pixel in column i and row j, both counted from 0, has its
/// centre at first_mm + i · pixel_width_mm · right + j · pixel_height_mm · down.
struct GreyPicture {
  double time_s = 0.0;  ///< moment that the picture shows
  int width = 0;        ///< number of columns
  int height = 0;       ///< number of rows
  double pixel_width_mm = 1.0;
  double pixel_height_mm = 1.0;
  Vec3 first_mm = Vec3::Zero();      ///< LPS, centre of the first pixel: top left
  Vec3 right = Vec3::UnitX();        ///< unit vector, LPS
  Vec3 down = Vec3::UnitY();         ///< unit vector, LPS, at right angles to `right`
  std::vector<std::uint8_t> values;  ///< (width · height) 0 = black … 255 = white, row by row from the top

  /// The centre of a pixel [mm] LPS.
  [[nodiscard]] Vec3 place_mm(double column, double row) const {
    return first_mm + column * pixel_width_mm * right + row * pixel_height_mm * down;
  }
};

}  // namespace stylet

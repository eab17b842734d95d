// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/imaging/grey_picture.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// The line that stands on every picture of a patient.
inline constexpr const char* kPictureNotice = "simulated; not a medical device";

/// The marks that are drawn on a picture for people. The pixels of a GreyPicture itself stay free of it.
struct PictureMarks {
  std::optional<double> surface_row;             ///< row at the depth 0: a scale in cm goes up from it; empty: no scale
  std::vector<std::array<double, 2>> dots = {};  ///< places (column, row)
  std::string title;                             ///< above the picture; empty: none
  std::string notice;                            ///< below the picture; empty: none
  /// Words after the length of a bar, which is below the picture as its scale, such as "at the gland"; empty: no bar.
  std::optional<std::string> bar_note = {};
};

/// Writes a picture with its marks as PNG. A small picture is enlarged by a whole number, so that there is room for its
/// marks. The file appears whole or not at all.
/// Errors: a file that cannot be written.
Result<> write_picture_png(const GreyPicture& picture, const PictureMarks& marks, const std::filesystem::path& path);

/// Writes pictures of parallel planes as a volume in MetaImage (.mha): grey values of 8 bit, with spacing, origin and
/// orientation in LPS, as 3D Slicer and ITK read them. The third axis is right × down.
/// @param pictures of equal size and orientation, along right × down; one gives a volume of one slice
/// @param distance_mm of the planes; of a single one its thickness
/// Errors: pictures that do not fit to each other; a file that cannot be written.
Result<> write_picture_mha(std::span<const GreyPicture> pictures, double distance_mm,
                           const std::filesystem::path& path);

}  // namespace stylet

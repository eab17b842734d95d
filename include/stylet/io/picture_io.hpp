// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/imaging/grey_picture.hpp"

#include <filesystem>
#include <string>

namespace stylet {

/// The line that stands below every picture of a patient.
inline constexpr const char* kPictureNotice = "simulated; not a medical device";

/// Writes a picture as PNG with a strip below it: a bar as scale, the caption, and kPictureNotice. A small picture is
/// enlarged by a whole number, so that there is room for the strip. Pixels must be square.
/// @param caption words such as "X-ray, 60 keV"; may be empty
/// @param scale_note words after the length of the bar, such as "at the gland"; may be empty
/// Errors: a folder that does not exist, errors of the disk; nothing half-written stays.
Result<> write_picture_png(const GreyPicture& picture, const std::string& caption, const std::string& scale_note,
                           const std::filesystem::path& path);

/// Writes the grey values of a picture and its place in the patient as MetaImage (.mha): one slice of a volume, LPS.
/// Errors: as write_picture_png().
Result<> write_picture_mha(const GreyPicture& picture, const std::filesystem::path& path);

}  // namespace stylet

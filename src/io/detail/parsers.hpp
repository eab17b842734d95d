// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/contours_io.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/io/mesh_io.hpp"

/// The parsers behind the public readers. They touch third-party code with untrusted bytes, may print, throw, hang or
/// die, and are therefore only called inside a child process (detail/guard.hpp).
namespace stylet::detail {

Result<ContourSet> parse_rtstruct(const std::filesystem::path& path);
Result<ContourSet> parse_contour_json(const std::filesystem::path& path);

Result<LabelImage> parse_nifti(const std::filesystem::path& path);
Result<LabelImage> parse_nrrd(const std::filesystem::path& path);
Result<LabelImage> parse_metaimage(const std::filesystem::path& path);

}  // namespace stylet::detail

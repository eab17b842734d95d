// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/contours_io.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/io/mesh_io.hpp"

/// The parsers behind the public readers. They touch third-party code with untrusted bytes, may print, throw, hang or
/// die, and are therefore only called inside a child process (detail/guard.hpp).
namespace stylet::detail {

Result<ContourSet> parse_rtstruct(const std::filesystem::path& path, std::span<const std::string> skip);
Result<ContourSet> parse_contour_json(const std::filesystem::path& path, std::span<const std::string> skip);

Result<LabelImage> parse_nifti(const std::filesystem::path& path, const MaskReadOptions& options);
Result<LabelImage> parse_nrrd(const std::filesystem::path& path, const MaskReadOptions& options);
Result<LabelImage> parse_metaimage(const std::filesystem::path& path, const MaskReadOptions& options);
Result<LabelImage> parse_dicom_seg(const std::filesystem::path& path, const MaskReadOptions& options);

/// Whether a DICOM file is a segmentation, by its SOP class.
bool is_dicom_seg(const std::filesystem::path& path);
/// The only RT Structure Set or segmentation in a folder.
Result<std::string> only_patient_in(const std::filesystem::path& folder);

}  // namespace stylet::detail

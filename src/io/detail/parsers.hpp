// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/contours_io.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/io/mesh_io.hpp"

/// The parsers behind the public readers. They give untrusted bytes to third-party code, which may print, throw, hang
/// or crash, and must therefore only be called in the reading program (reading/ask.hpp).
namespace stylet::detail {

Result<ContourSet> parse_rtstruct(const std::filesystem::path& path, std::span<const std::string> skip);
Result<ContourSet> parse_contour_json(const std::filesystem::path& path, std::span<const std::string> skip);

Result<LabelImage> parse_nifti(const std::filesystem::path& path, const MaskReadOptions& options);
Result<LabelImage> parse_nrrd(const std::filesystem::path& path, const MaskReadOptions& options);
Result<LabelImage> parse_metaimage(const std::filesystem::path& path, const MaskReadOptions& options);
Result<LabelImage> parse_dicom_seg(const std::filesystem::path& path, const MaskReadOptions& options);

/// Whether a DICOM file is a segmentation, according to its SOP class.
bool is_dicom_seg(const std::filesystem::path& path);
/// The file name of the only RT Structure Set or segmentation in a folder. Error if there is none or more than one.
Result<std::string> only_patient_in(const std::filesystem::path& folder);

}  // namespace stylet::detail

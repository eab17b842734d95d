// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/patient_record.hpp"
#include "stylet/geom/contours.hpp"

#include <filesystem>
#include <span>

namespace stylet {

/// Reads a DICOM RT Structure Set (a file, or a directory that holds exactly one). Only closed planar contours are
/// read; empty ROIs and open curves are ignored, with a note in the result.
/// @param skip names of structures that are not needed: a damaged one is ignored instead of being an error
Result<ContourSet> read_rtstruct(const std::filesystem::path& path, std::span<const std::string> skip = {});

/// Writes a DICOM RT Structure Set. On error no incomplete file is left.
/// @param patient whose structures they are; what it does not say is empty in the file
Result<> write_rtstruct(const ContourSet& contours, const std::filesystem::path& path,
                        const PatientRecord& patient = {});

/// Reads a contour set in JSON (docs/formats.md).
/// @param skip as for read_rtstruct()
Result<ContourSet> read_contour_json(const std::filesystem::path& path, std::span<const std::string> skip = {});
/// Writes a contour set in JSON (docs/formats.md).
Result<> write_contour_json(const ContourSet& contours, const std::filesystem::path& path);

}  // namespace stylet

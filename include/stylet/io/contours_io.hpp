// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/patient_record.hpp"
#include "stylet/geom/contours.hpp"

#include <filesystem>
#include <optional>
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

/// Checks that contours can describe a structure. Errors: fewer than three points, self-crossing contours, a single
/// slice, NaN, contours that are not parallel to each other, an extent that indicates wrong units (< 1 mm or > 2 m).
/// @param roi the structure
/// @param where file name for the message
Result<> check_roi(const Roi& roi, const std::string& where);

/// A note for the user if the side that closes a contour, from its last point to its first, is far longer than all its
/// other sides: it may be a straight side, or a curve that somebody forgot to close. Contours are closed by definition
/// (DICOM CLOSED_PLANAR), so neither is an error.
std::optional<std::string> long_closing_side(const Roi& roi);

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/contours.hpp"

#include <filesystem>

namespace stylet {

/// Reads a DICOM RT Structure Set (one file, or a directory that holds exactly one). Closed planar contours only; empty
/// ROIs and open curves are passed over with a note.
Result<ContourSet> read_rtstruct(const std::filesystem::path& path);

/// Writes a DICOM RT Structure Set without patient-identifying data. The file appears whole or not at all.
Result<> write_rtstruct(const ContourSet& contours, const std::filesystem::path& path);

/// Contour JSON (docs/formats.md).
Result<ContourSet> read_contour_json(const std::filesystem::path& path);
Result<> write_contour_json(const ContourSet& contours, const std::filesystem::path& path);

/// Refuses what cannot be a structure: fewer than three points, self-crossing or open contours, one slice only, NaN,
/// contours not parallel to each other, extents that betray wrong units (< 1 mm or > 2 m).
/// @param roi the structure
/// @param where file name for the message
Result<> check_roi(const Roi& roi, const std::string& where);

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/contours.hpp"

#include <filesystem>
#include <optional>
#include <span>

namespace stylet {

/// Reads a DICOM RT Structure Set (one file, or a directory that holds exactly one). Closed planar contours only; empty
/// ROIs and open curves are passed over, which the set says.
/// @param skip names of structures that nobody will miss: where one is damaged it is passed over as well
Result<ContourSet> read_rtstruct(const std::filesystem::path& path, std::span<const std::string> skip = {});

/// Writes a DICOM RT Structure Set without patient-identifying data. The file appears whole or not at all.
Result<> write_rtstruct(const ContourSet& contours, const std::filesystem::path& path);

/// Contour JSON (docs/formats.md).
/// @param skip as for read_rtstruct()
Result<ContourSet> read_contour_json(const std::filesystem::path& path, std::span<const std::string> skip = {});
Result<> write_contour_json(const ContourSet& contours, const std::filesystem::path& path);

/// Refuses what cannot be a structure: fewer than three points, self-crossing contours, one slice only, NaN, contours
/// not parallel to each other, extents that betray wrong units (< 1 mm or > 2 m).
/// @param roi the structure
/// @param where file name for the message
Result<> check_roi(const Roi& roi, const std::string& where);

/// A sentence for the user where the side that closes a contour, from its last point to its first, is far longer than
/// all its other sides: a straight side, or a curve that somebody forgot to close. Contours are closed by definition
/// (DICOM CLOSED_PLANAR), so neither is an error.
std::optional<std::string> long_closing_side(const Roi& roi);

}  // namespace stylet

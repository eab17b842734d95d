// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/contours_io.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/io/mesh_io.hpp"

#include <variant>

namespace stylet {

/// Whatever a user may name as a patient.
using PatientInput = std::variant<ContourSet, LabelImage, TetMesh, std::vector<Surface>>;

/// Finds out what a file (or a directory with one RTSTRUCT or DICOM SEG in it) is, by content before extension, and
/// reads it. Untrusted files go through a child process with limits on time and memory, so a parser's crash becomes an
/// error.
/// @param skip names of structures of a contour set that nobody will miss, even where they are damaged, and of segments
/// (MaskReadOptions::skip)
Result<PatientInput> read_input(const std::filesystem::path& path, const MeshReadOptions& mesh_options = {},
                                const MaskReadOptions& mask_options = {}, std::span<const std::string> skip = {});

}  // namespace stylet

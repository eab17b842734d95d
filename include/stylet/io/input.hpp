// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/contours_io.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/io/mesh_io.hpp"

#include <variant>

namespace stylet {

/// The content of any file that can describe a patient.
using PatientInput = std::variant<ContourSet, LabelImage, TetMesh, std::vector<Surface>>;

/// Reads a patient's file, or a directory with one RTSTRUCT or DICOM SEG in it, after detecting its format from its
/// content, then from its extension. Untrusted files are parsed by the program stylet-reader with limits on time and
/// memory, so that a crash of a parser becomes an error.
/// @param skip names of structures and segments that are not needed. A damaged structure among them is ignored instead
///   of being an error; segments are treated as by MaskReadOptions::skip
Result<PatientInput> read_input(const std::filesystem::path& path, const MeshReadOptions& mesh_options = {},
                                const MaskReadOptions& mask_options = {}, std::span<const std::string> skip = {});

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/input.hpp"
#include "stylet/mesher/mesher.hpp"

namespace stylet {

/// The content of a patient's file, and what was noticed while it was read.
struct PatientFile {
  PatientInput content;
  std::vector<std::string> notes;  ///< for the user: what was passed over, put right or looks odd
};

/// read_input() for a patient that is to be meshed: refuses as well contours that cannot be a structure (check_roi),
/// but only those that the mesher would use; nobody has to repair a planning helper.
Result<PatientFile> read_patient(const std::filesystem::path& path, const MeshReadOptions& read_options,
                                 const MeshOptions& mesh_options, const MaskReadOptions& mask_options = {});

}  // namespace stylet

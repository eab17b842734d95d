// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/input.hpp"
#include "stylet/mesher/mesher.hpp"

namespace stylet::cli {

/// read_input() for a patient that is to be meshed: refuses as well contours that cannot be a structure (check_roi),
/// but only those that the mesher would use; nobody has to repair a planning helper.
Result<PatientInput> read_patient(const std::filesystem::path& path, const MeshReadOptions& read_options,
                                  const MeshOptions& mesh_options, const MaskReadOptions& mask_options = {});

}  // namespace stylet::cli

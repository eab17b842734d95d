// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/input.hpp"
#include "stylet/mesher/mesher.hpp"

namespace stylet {

/// The content of a patient's file.
struct PatientFile {
  PatientInput content;
  std::vector<std::string> notes;     ///< sentences for the user: what was left out, corrected or looks odd
  std::vector<std::string> warnings;  ///< sentences for the user: why this may be no patient for this program
};

/// Reads the file of a patient that will be meshed: read_input(), and then structure_slices() for the structures that
/// the mesher will use. Other structures, such as helpers of the planning software, are not checked. Then the patient
/// is judged (judge_fit()): one that is refused is an error.
Result<PatientFile> read_patient(const std::filesystem::path& path, const MeshReadOptions& read_options,
                                 const MeshOptions& mesh_options, const MaskReadOptions& mask_options = {});

}  // namespace stylet

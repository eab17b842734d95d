// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"
#include "stylet/io/input.hpp"

#include <map>
#include <string>
#include <vector>

namespace stylet {

/// The structures of a patient's file, sampled for their dose.
struct DoseStructures {
  std::vector<DoseStructure> structures;
  std::string frame_of_reference;  ///< of a DICOM structure set; empty for others
  std::vector<std::string> notes;  ///< sentences for the user: what was left out, and which structure is the target
};

/// Choices for dose_structures().
struct DoseStructureOptions {
  std::map<std::string, std::string> regions;  ///< structures that the user assigns: name → region
  std::vector<std::string> skip;               ///< names of structures to leave out
  double step_mm = 0.0;                        ///< distance of samples [mm]; 0: sampling_step_mm() of each structure
};

/// Samples all structures of a patient's file: contours, labels of a mask, or regions of a mesh. Structures are
/// recognised by their names as for meshing, so that the target is the region "prostate". A structure whose contours
/// are damaged is left out with a note.
/// Errors: the input has no structure that has a volume; a name in `skip` or `regions` that it does not have.
Result<DoseStructures> dose_structures(const PatientInput& input, const DoseStructureOptions& options,
                                       const Progress& progress = {});

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/structures.hpp"

namespace stylet::meshing {

/// A structure of the input for whose use is to be decided.
struct Candidate {
  std::string name;     ///< as in the file
  std::string meaning;  ///< name of a code that the file gives for it, used where `name` is not recognised; or empty
  int number = 0;       ///< number of the ROI or label
  std::string type;     ///< DICOM interpreted type, or empty
  std::string word;     ///< another word by which the user may name it: the number of a label; or empty
  std::string nothing;  ///< in a few words, why it has nothing to mesh; empty: it has something
};

/// Decides the use of all candidates, without regard to MeshOptions::preset.
/// @param source name of the input in messages
/// @param kind word for a candidate in messages: "structure" or "label"
/// @param apart whether candidates cannot overlap, like the labels of a mask
Result<std::vector<StructureUse>> decide(const std::vector<Candidate>& candidates, const MeshOptions& options,
                                         const std::string& source, const std::string& kind, bool apart);

/// Completes a choice: separates candidates without anything to mesh, and writes notes about what is left out.
/// @param uses one for each candidate
StructureChoice told(std::vector<StructureUse> uses, const std::vector<Candidate>& candidates, const std::string& kind);

/// Marks a structure as left out.
void leave_out(StructureUse& use, std::string why);

/// First words of the reason why a planning volume is left out.
inline constexpr const char* kPlanningVolume = "planning volume";
inline constexpr const char* kEmpty = "empty";
inline constexpr const char* kSkipped = "named in [patient] skip";
inline constexpr const char* kNotRecognised = "name not recognised";
inline constexpr const char* kPaperTakesTheGland = "mesh.preset = \"paper\" meshes the gland only";

}  // namespace stylet::meshing

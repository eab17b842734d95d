// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/structures.hpp"

namespace stylet::meshing {

/// A structure of the input before it is decided what it becomes.
struct Candidate {
  std::string name;     ///< as in the file
  std::string meaning;  ///< a coded term of the file for it, which counts where the name says nothing; or empty
  int number = 0;       ///< of the ROI or label
  std::string type;     ///< DICOM's interpreted type, or empty
  std::string word;     ///< another word for it: a label's number; or empty
  std::string nothing;  ///< why it has nothing to be meshed, in a few words; empty: it has
};

/// What becomes of the candidates, but for MeshOptions::preset and the notes.
/// @param source what to call the input in messages
/// @param kind what to call a candidate in messages: "structure", "label"
/// @param apart no two candidates overlap, as the labels of a mask
Result<std::vector<StructureUse>> decide(const std::vector<Candidate>& candidates, const MeshOptions& options,
                                         const std::string& source, const std::string& kind, bool apart);

/// The finished choice: candidates without anything to be meshed set apart, and all that is left out said.
/// @param uses one for each candidate
StructureChoice told(std::vector<StructureUse> uses, const std::vector<Candidate>& candidates, const std::string& kind);

/// Leaves a structure out.
void leave_out(StructureUse& use, std::string why);

/// Begins the reason why a planning volume is left out.
inline constexpr const char* kPlanningVolume = "planning volume";
inline constexpr const char* kEmpty = "empty";
inline constexpr const char* kSkipped = "named in [patient] skip";
inline constexpr const char* kNotRecognised = "name not recognised";
inline constexpr const char* kPaperTakesTheGland = "mesh.preset = \"paper\" takes the gland only";

}  // namespace stylet::meshing

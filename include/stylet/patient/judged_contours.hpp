// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/structure_slices.hpp"
#include "stylet/mesher/structures.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// Judgement of one structure of a contour set: its use, and what is wrong with it.
struct JudgedStructure {
  const Roi* roi = nullptr;               ///< the structure in the contour set
  StructureUse use;                       ///< the region that it becomes, or why it is left out
  std::optional<StructureSlices> slices;  ///< the meaning of its contours; nothing if there is a fault
  std::optional<Error> fault;             ///< why its contours cannot be a structure; matters only if it is used
  std::optional<std::string> oddity;      ///< note for the user about contours that look odd (long_closing_side())

  [[nodiscard]] bool is_used() const { return !use.region.empty(); }
};

/// Judgement of all structures of a contour set.
struct JudgedContours {
  std::vector<JudgedStructure> structures;  ///< one for each Roi of the set, in their order
  StructureChoice choice;                   ///< the uses again, with notes about them

  /// The first fault of a structure that is used; null if all of them can be meshed.
  [[nodiscard]] const Error* fault() const;
  /// Notes for the user about structures that are used and look odd.
  [[nodiscard]] std::vector<std::string> oddities() const;
};

/// Judges the structures of a contour set: choose_structures(), structure_slices() and long_closing_side() together.
/// read_patient(), `stylet info` and its draft of a scenario all use this function.
/// @param contours must outlive the result
/// Errors: those of choose_structures(). A fault of a structure is reported in JudgedStructure::fault and is not an
/// error here.
Result<JudgedContours> judge_contours(const ContourSet& contours, const MeshOptions& options);

}  // namespace stylet

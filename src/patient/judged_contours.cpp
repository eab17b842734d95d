// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/judged_contours.hpp"

namespace stylet {

const Error* JudgedContours::fault() const {
  for (const JudgedStructure& structure : structures) {
    if (structure.is_used() && structure.fault) return &*structure.fault;
  }
  return nullptr;
}

std::vector<std::string> JudgedContours::oddities() const {
  std::vector<std::string> all;
  for (const JudgedStructure& structure : structures) {
    if (structure.is_used() && structure.oddity) all.push_back(*structure.oddity);
  }
  return all;
}

Result<JudgedContours> judge_contours(const ContourSet& contours, const MeshOptions& options) {
  Result<StructureChoice> choice = choose_structures(contours, options);
  if (!choice) return choice.error();
  JudgedContours judged;
  auto use = choice->uses.begin();  // has the structures with contours, in their order
  for (const Roi& roi : contours.rois) {
    JudgedStructure& structure = judged.structures.emplace_back();
    structure.roi = &roi;
    if (!roi.contours.empty()) structure.use = *use++;
    Result<StructureSlices> slices = structure_slices(roi, contours.source);
    if (slices) {
      structure.slices = *std::move(slices);
    } else {
      structure.fault = slices.error();
    }
    structure.oddity = long_closing_side(roi);
  }
  judged.choice = *std::move(choice);
  return judged;
}

}  // namespace stylet

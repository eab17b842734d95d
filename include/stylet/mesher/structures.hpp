// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"

namespace stylet {

/// Use of one structure of a contour set, or of one label of a mask.
struct StructureUse {
  std::string name;    ///< as in the file; the number of a label without a name
  int number = 0;      ///< number of the ROI or label
  std::string region;  ///< name of the region as which it is meshed; empty: it is left out
  std::string why;     ///< in a few words, why it is left out, or how it got its region if not by its name
};

/// Use of all structures of an input.
struct StructureChoice {
  std::vector<StructureUse> uses;   ///< structures with contours, in their order, or labels, ascending
  std::vector<StructureUse> empty;  ///< structures without anything to mesh; all are left out
  /// Messages to the user: which structure stands in for another one, then the messages of `left_out`.
  std::vector<std::string> notes;
  std::vector<std::string> left_out;  ///< messages to the user: which structures are left out, and why
  bool has_target = false;            ///< whether one of the regions is the target
};

/// Decides how the structures of a contour set are used: by MeshOptions::skip, then by MeshOptions::regions, then by
/// the structures' names, then by their DICOM types. A planning volume (CTV, target, PTV, GTV) is used as the gland if
/// nothing else is the gland; likewise a structure of the type EXTERNAL is used as the body. Errors: a name in skip or
/// regions that the input does not have, with the nearest name that it has; a structure named in regions that has
/// nothing to mesh.
Result<StructureChoice> choose_structures(const ContourSet& contours, const MeshOptions& options);

/// Decides the same for a label mask. If MeshOptions::regions is empty, labels without a recognised name become regions
/// of their own ("label_2"). A planning volume that would be left out, and that touches more of the target than of
/// anything else, becomes part of the target: without it the target would have a hole.
Result<StructureChoice> choose_structures(const LabelImage& image, const MeshOptions& options);

}  // namespace stylet

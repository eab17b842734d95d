// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"

namespace stylet {

/// What one structure of a contour set, or one label of a mask, becomes.
struct StructureUse {
  std::string name;    ///< as in the file; the number of a label without a name
  int number = 0;      ///< of the ROI or label
  std::string region;  ///< name of the region it is meshed as; empty: it is left out
  std::string why;     ///< why it is left out, in a few words; or how it came by its region where not by its name
};

/// What becomes of the structures of an input.
struct StructureChoice {
  std::vector<StructureUse> uses;   ///< of the ROIs that have contours, in their order; or of the labels, ascending
  std::vector<StructureUse> empty;  ///< of structures that have nothing to be meshed, all left out
  std::vector<std::string> notes;   ///< for the user: what stands in for what, and all that is left out, with reasons
  bool has_target = false;          ///< one of the regions is the target
};

/// Decides by MeshOptions::skip, then MeshOptions::regions, then the structures' names, then their DICOM types. A
/// planning volume (CTV, target, PTV, GTV) is the gland where nothing else is; so is EXTERNAL the body.
/// Errors: a name in skip or regions that the input does not have, with the nearest one that it has; a structure that
/// is asked for and has nothing to be meshed.
Result<StructureChoice> choose_structures(const ContourSet& contours, const MeshOptions& options);

/// The same for a mask. Without MeshOptions::regions, labels that have no name or one that is not recognised are
/// regions of their own ("label_2"). A planning volume that would be left out, and that touches more of the target than
/// of anything else, is a part of the target: left out it would be a hole in it.
Result<StructureChoice> choose_structures(const LabelImage& image, const MeshOptions& options);

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/label_image.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet {

struct MaskReadOptions {
  int volume = 0;  ///< number of the volume in a file with several, from 1; 0 = the only one
  /// Names or numbers of segments to ignore; segments below them keep their voxels.
  std::vector<std::string> skip = {};
};

/// Reads a label mask: NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd, .nhdr, .seg.nrrd), MetaImage (.mha, .mhd), DICOM SEG. The
/// image frame (oblique, left-handed) is kept; NIfTI's RAS and NRRD's declared space become LPS. Where segments
/// overlap, the voxel belongs to the smaller segment.
Result<LabelImage> read_label_image(const std::filesystem::path& path, const MaskReadOptions& options = {});

}  // namespace stylet

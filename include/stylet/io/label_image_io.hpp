// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/label_image.hpp"

#include <filesystem>

namespace stylet {

/// Reads a label mask: NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd, .nhdr, .seg.nrrd), MetaImage (.mha, .mhd). The image frame
/// (oblique, left-handed) is kept; NIfTI's RAS and NRRD's declared space become LPS.
Result<LabelImage> read_label_image(const std::filesystem::path& path);

}  // namespace stylet

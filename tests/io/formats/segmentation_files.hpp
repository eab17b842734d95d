// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "files.hpp"
#include "mask_files.hpp"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <functional>
#include <string>
#include <vector>

namespace stylet::test {

/// A structure of a segmentation, drawn in the grid of a Mask.
struct Drawn {
  std::string label;    ///< the segment's name
  std::string meaning;  ///< of its property type code
  std::function<bool(int i, int j, int k)> inside;
};

/// A DICOM SEG as DCMTK's own module for them (dcmseg) writes it: one frame for each slice of a segment that is not
/// empty, the highest slice first.
/// @param frame its size, axes and origin are used
/// @param most 0 = BINARY, else FRACTIONAL with this maximum; `partial` gives a voxel's value then
fs::path write_seg(const fs::path& path, const Mask& frame, const std::vector<Drawn>& segments, int most = 0,
                   const std::function<int(int i, int j, int k)>& partial = {});

/// Changes a DICOM file in place.
fs::path edit_dicom(const fs::path& path, const std::function<void(DcmDataset&)>& change);

/// The item of a functional group of one frame, counted from 0.
DcmItem& group_of_frame(DcmDataset& data, int frame, const DcmTagKey& group);

/// A .seg.nrrd with a layer for each entry of `layers` (voxels' labels in the grid of `frame`); `keys` are header
/// lines.
std::string layered_nrrd(const Mask& frame, const std::vector<std::vector<std::uint8_t>>& layers,
                         const std::string& keys);

}  // namespace stylet::test

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

/// A structure of a segmentation on the grid of a Mask.
struct Drawn {
  std::string label;    ///< the segment's name
  std::string meaning;  ///< meaning of its property type code
  std::function<bool(int i, int j, int k)> inside;
};

/// Writes a DICOM SEG with DCMTK's module dcmseg: one frame for each slice of a segment that is not empty, the highest
/// slice first.
/// @param frame gives size, axes and origin
/// @param most 0 = BINARY, else FRACTIONAL with this maximum; `partial` then gives a voxel's value
fs::path write_seg(const fs::path& path, const Mask& frame, const std::vector<Drawn>& segments, int most = 0,
                   const std::function<int(int i, int j, int k)>& partial = {});

/// Changes the data set of a DICOM file.
fs::path edit_dicom(const fs::path& path, const std::function<void(DcmDataset&)>& change);

/// The item of a functional group of a frame. @param frame from 0
DcmItem& group_of_frame(DcmDataset& data, int frame, const DcmTagKey& group);

/// The bytes of a .seg.nrrd with a layer for each entry of `layers` (labels on the grid of `frame`) and with `keys` as
/// further header lines.
std::string layered_nrrd(const Mask& frame, const std::vector<std::vector<std::uint8_t>>& layers,
                         const std::string& keys);

}  // namespace stylet::test

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/label_image.hpp"

#include <string>
#include <vector>

namespace stylet::detail {

/// One structure of a segmentation in which structures may overlap.
struct Segment {
  int label = 0;  ///< 1…65535, unique
  std::string name;
  std::string meaning;       ///< of its code, empty where there is none
  std::vector<bool> inside;  ///< one per voxel of the image
};

/// Paints the segments into image.labels (of the image's size, all 0). Where segments overlap, the smaller one, by its
/// voxels, has the voxel: what is inside something else is the more specific of both (the urethra or a zone inside the
/// gland). Of two equally large ones the later has it. Names and notes on overlaps and on empty segments go into the
/// image.
void paint(std::vector<Segment> segments, LabelImage& image);

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/label_image.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stylet::detail {

/// One structure of a segmentation in which structures may overlap.
struct Segment {
  int label = 0;  ///< 1…65535, unique
  std::string name;
  std::string meaning;  ///< meaning of its code; empty if there is none
};

/// Consecutive voxels of one segment in the image.
struct Run {
  std::uint32_t first = 0, count = 0;
  std::uint32_t segment = 0;  ///< position in the list of segments
};

/// Adds a voxel of a segment to the runs.
inline void add_voxel(std::vector<Run>& runs, std::size_t voxel, std::size_t segment) {
  if (!runs.empty() && runs.back().segment == segment && runs.back().first + std::size_t{runs.back().count} == voxel) {
    ++runs.back().count;
  } else {
    runs.push_back({static_cast<std::uint32_t>(voxel), 1, static_cast<std::uint32_t>(segment)});
  }
}

/// Paints the segments into image.labels (of the image's size, all 0). Where segments overlap, the voxel belongs to the
/// segment with fewer voxels, because a structure inside another is the more specific one (the urethra or a zone inside
/// the gland); of two equally large segments, to the later one. Names, and notes on overlaps and empty segments, are
/// added to the image.
/// @param skip names or labels of segments that are left out: segments below them keep their voxels
/// Errors: every segment is left out.
Result<> paint(const std::vector<Segment>& segments, const std::vector<Run>& runs, std::span<const std::string> skip,
               LabelImage& image);

}  // namespace stylet::detail

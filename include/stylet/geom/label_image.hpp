// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace stylet {

/// A segmentation: one label per voxel, 0 = background.
/// Voxel (i,j,k) has its centre at origin + direction * (spacing ∘ (i,j,k)). Left-handed frames (det(direction) = -1)
/// are legal and kept.
struct LabelImage {
  std::string source;                   ///< file it was read from
  std::array<Index, 3> size{0, 0, 0};   ///< voxels along i, j, k
  Vec3 origin = Vec3::Zero();           ///< [mm] LPS, centre of voxel (0,0,0)
  Vec3 spacing = Vec3::Ones();          ///< [mm]
  Mat3 direction = Mat3::Identity();    ///< columns: unit directions of i, j, k in LPS
  std::vector<std::uint16_t> labels;    ///< i fastest (size[0]*size[1]*size[2])
  std::map<int, std::string> names;     ///< names of labels where the file gives them (.seg.nrrd, DICOM SEG)
  std::map<int, std::string> meanings;  ///< what a code beside the name says that the label is (DICOM SEG)
  std::vector<std::string> notes;       ///< what the reader decided, in words for the user

  [[nodiscard]] Vec3 voxel_centre(double i, double j, double k) const {
    return origin + direction * spacing.cwiseProduct(Vec3(i, j, k));
  }
};

}  // namespace stylet

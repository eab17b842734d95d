// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace stylet {

/// A segmentation: one label per voxel, 0 = background. The centre of voxel (i,j,k) is at origin + direction * (spacing
/// ∘ (i,j,k)). Left-handed frames (det(direction) = -1) are valid and stay left-handed.
struct LabelImage {
  std::string source;                  ///< file from which the image was read
  std::array<Index, 3> size{0, 0, 0};  ///< number of voxels along i, j, k
  Vec3 origin = Vec3::Zero();          ///< [mm] LPS, centre of voxel (0,0,0)
  Vec3 spacing = Vec3::Ones();         ///< [mm] distance of voxel centres along i, j, k
  Mat3 direction = Mat3::Identity();   ///< columns: unit directions of i, j, k in LPS
  std::vector<std::uint16_t> labels;   ///< (size[0]*size[1]*size[2]) one label per voxel, i varies fastest
  std::map<int, std::string> names;    ///< names of the labels that the file names (.seg.nrrd, DICOM SEG)
  /// Anatomical meanings of the labels, in words: DICOM SEG files give a label a coded meaning in addition to its name.
  std::map<int, std::string> meanings;
  std::vector<std::string> notes;  ///< messages to the user about decisions of the reader

  [[nodiscard]] Vec3 voxel_centre(double i, double j, double k) const {
    return origin + direction * spacing.cwiseProduct(Vec3(i, j, k));
  }
};

}  // namespace stylet

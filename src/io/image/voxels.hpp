// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/label_image.hpp"

#include <cstddef>
#include <span>
#include <string>

namespace stylet::detail {

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// A 3D image as a format's library hands it over, before anyone has asked whether it is a segmentation.
struct Voxels {
  std::string source;  ///< file
  std::array<std::size_t, 3> size{0, 0, 0};
  VoxelType type = VoxelType::uint8;
  const void* data = nullptr;  ///< i fastest; size[0]*size[1]*size[2] values in the machine's byte order
  double slope = 1.0;          ///< label = slope * stored + intercept
  double intercept = 0.0;
  Mat3 axes = Mat3::Identity();  ///< [mm] LPS, columns: steps from one voxel to the next along i, j, k
  Vec3 origin = Vec3::Zero();    ///< [mm] LPS, centre of voxel (0,0,0)
};

/// Turns an image into a segmentation, or says why it is none: 2D, no finite or a degenerate or sheared frame,
/// negative, fractional or too many different values, nothing but background, extent of the segmentation < 1 mm or > 2
/// m.
Result<LabelImage> to_label_image(const Voxels& voxels);

/// Refuses an image that is not 3D, or a series of several 3D images.
/// @param sizes (dimensions) voxels along each axis of the file
Result<> check_dimensions(std::span<const std::size_t> sizes, const std::string& source);

}  // namespace stylet::detail

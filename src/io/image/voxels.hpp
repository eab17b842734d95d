// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/label_image.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet::detail {

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Number of bytes of a voxel.
std::size_t bytes_in(VoxelType type);

/// A 3D image as a format's library returns it, before it is checked whether it is a segmentation.
struct Voxels {
  std::string source;  ///< file name for messages
  std::array<std::size_t, 3> size{0, 0, 0};
  VoxelType type = VoxelType::uint8;
  const void* data = nullptr;  ///< i fastest; size[0]*size[1]*size[2] values in the machine's byte order
  double slope = 1.0;          ///< label = slope * stored + intercept
  double intercept = 0.0;
  Mat3 axes = Mat3::Identity();           ///< [mm] LPS, columns: steps from one voxel to the next along i, j, k
  Vec3 origin = Vec3::Zero();             ///< [mm] LPS, centre of voxel (0,0,0)
  std::string origin_field = "origin";    ///< the format's name for the origin, for messages
  std::string spacing_field = "spacing";  ///< the format's name for the spacing, for messages
  std::vector<std::string> notes;         ///< decisions of the reader, for the user
};

/// Why these axes are not those of a regular grid, in words: one that has no length, or two that are not perpendicular.
/// Empty if they are. @param axes columns: steps from one voxel to the next along i, j, k
std::optional<std::string> fault_of_axes(const Mat3& axes);

/// Splits the frame of `voxels` into origin, spacing and directions of `image`, and sets its size. Errors: fewer than
/// two voxels along an axis, too many voxels, a frame that is not finite, out of reach (detail/reach.hpp), degenerate
/// or sheared; each with the format's own name of the field.
Result<> set_frame(const Voxels& voxels, LabelImage& image);

/// Error if a segmentation is empty, or if its extent is < 1 mm or > 2 m.
Result<> check_extent(const LabelImage& image);

/// The values as labels, with notes on what was not a label as it stands:
/// - Values near whole numbers are rounded if all are within 0.01 of one, or within half a step of a scaled image (at
///   most 0.05), as labels are that were stored in quantised steps.
/// - NaN is background, and so is the only negative value of an image if it is −1 or if no voxel is 0.
/// Errors: other values; an image with grey values instead of labels.
Result<std::vector<std::uint16_t>> labels_of(const Voxels& voxels, std::vector<std::string>& notes);

/// Converts an image into a segmentation. Errors: as set_frame(), labels_of() and check_extent().
Result<LabelImage> to_label_image(const Voxels& voxels);

/// Index of the chosen volume in a file, from 0. Errors: not 3D, too few voxels, several volumes and none chosen, a
/// number that the file does not have.
/// @param sizes (dimensions) number of voxels along each axis of the file; axes after the third count volumes
/// @param chosen number of the volume, from 1; 0 = the only one
Result<std::size_t> choose_volume(std::span<const std::size_t> sizes, int chosen, const std::string& source);

}  // namespace stylet::detail

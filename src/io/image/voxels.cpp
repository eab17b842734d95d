// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <set>

namespace stylet::detail {

namespace {

constexpr std::size_t max_distinct_labels = 500;  // more is a grey-value picture
constexpr double max_shear = 1e-3;                // |cosine| between two axes; headers are single precision

const char* const mask_cure = "Name a label mask: 0 outside, one whole number per structure.";

/// Copies values to labels; T is the file's type.
template <class T>
Result<> copy_labels(const Voxels& voxels, LabelImage& image) {
  const T* data = static_cast<const T*>(voxels.data);
  const std::size_t nx = voxels.size[0], ny = voxels.size[1];
  std::set<double> distinct;
  double last_seen = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t n = 0; n < image.labels.size(); ++n) {
    const double value = voxels.slope * static_cast<double>(data[n]) + voxels.intercept;
    if (value == last_seen) {  // runs of equal labels make up most of a mask
      image.labels[n] = static_cast<std::uint16_t>(value);
      continue;
    }
    const auto where = [&] {
      return fmt::format("{}, voxel ({}, {}, {})", voxels.source, n % nx, n / nx % ny, n / (nx * ny));
    };
    if (!std::isfinite(value) || value != std::floor(value)) {
      return input_error(where(),
                         fmt::format("the value {:.6g} is not a whole number: this is a picture or a "
                                     "probability map, not a label mask",
                                     value),
                         mask_cure);
    }
    if (value < 0 || value > std::numeric_limits<std::uint16_t>::max()) {
      return input_error(where(), fmt::format("the label {:.0f} is outside 0…65535", value), mask_cure);
    }
    distinct.insert(value);
    if (distinct.size() > max_distinct_labels) {
      return input_error(
          voxels.source,
          fmt::format("more than {} different values: this is a picture, not a label mask", max_distinct_labels),
          mask_cure);
    }
    image.labels[n] = static_cast<std::uint16_t>(value);
    last_seen = value;
  }
  return Ok{};
}

Result<> copy_labels(const Voxels& voxels, LabelImage& image) {
  switch (voxels.type) {
    case VoxelType::int8:
      return copy_labels<std::int8_t>(voxels, image);
    case VoxelType::uint8:
      return copy_labels<std::uint8_t>(voxels, image);
    case VoxelType::int16:
      return copy_labels<std::int16_t>(voxels, image);
    case VoxelType::uint16:
      return copy_labels<std::uint16_t>(voxels, image);
    case VoxelType::int32:
      return copy_labels<std::int32_t>(voxels, image);
    case VoxelType::uint32:
      return copy_labels<std::uint32_t>(voxels, image);
    case VoxelType::int64:
      return copy_labels<std::int64_t>(voxels, image);
    case VoxelType::uint64:
      return copy_labels<std::uint64_t>(voxels, image);
    case VoxelType::float32:
      return copy_labels<float>(voxels, image);
    case VoxelType::float64:
      return copy_labels<double>(voxels, image);
  }
  return Ok{};
}

/// Splits the steps into spacing and unit directions.
Result<> set_frame(const Voxels& voxels, LabelImage& image) {
  const char* const cure = "Write the image again with a valid orientation, e.g. from 3D Slicer.";
  if (!voxels.axes.allFinite() || !voxels.origin.allFinite()) {
    return input_error(voxels.source, "the image frame (origin, spacing, directions) holds values that are not finite",
                       cure);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double length = voxels.axes.col(axis).norm();
    if (!(length > 0.0)) {
      return input_error(voxels.source, fmt::format("the voxel spacing along axis {} is zero", "ijk"[axis]), cure);
    }
    image.spacing[axis] = length;
    image.direction.col(axis) = voxels.axes.col(axis) / length;
  }
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 3; ++b) {
      const double cosine = image.direction.col(a).dot(image.direction.col(b));
      if (std::abs(cosine) > max_shear) {
        return input_error(voxels.source,
                           fmt::format("the image axes {} and {} enclose {:.2f}°, 90° is expected (a sheared image)",
                                       "ijk"[a], "ijk"[b], std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / M_PI),
                           "Resample the mask to a regular grid, e.g. with 3D Slicer.");
      }
    }
  }
  image.origin = voxels.origin;
  return Ok{};
}

/// The segmentation must not be empty and must have the size of something in a patient.
Result<> check_extent(const LabelImage& image) {
  std::array<Index, 3> low = image.size, high{-1, -1, -1};
  std::size_t n = 0;
  for (Index k = 0; k < image.size[2]; ++k) {
    for (Index j = 0; j < image.size[1]; ++j) {
      for (Index i = 0; i < image.size[0]; ++i, ++n) {
        if (image.labels[n] == 0) continue;
        const std::array<Index, 3> voxel{i, j, k};
        for (int a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], voxel[a]);
          high[a] = std::max(high[a], voxel[a]);
        }
      }
    }
  }
  if (high[0] < 0) {
    return input_error(image.source, "the mask is empty: every voxel is 0", "Segment a structure before exporting.");
  }
  double extent = 0.0;
  for (int a = 0; a < 3; ++a) extent = std::max(extent, (high[a] - low[a] + 1) * image.spacing[a]);
  if (extent < 1.0 || extent > 2000.0) {
    return input_error(image.source,
                       fmt::format("the segmentation is {:.4g} mm long, 1 mm to 2 m is expected; voxel spacing "
                                   "{:.4g} × {:.4g} × {:.4g} mm",
                                   extent, image.spacing[0], image.spacing[1], image.spacing[2]),
                       "The file's unit is probably not mm; correct its spacing.");
  }
  return Ok{};
}

}  // namespace

Result<> check_dimensions(std::span<const std::size_t> sizes, const std::string& source) {
  std::size_t dimensions = sizes.size();
  while (dimensions > 3 && sizes[dimensions - 1] == 1) --dimensions;
  if (dimensions > 3) {
    return input_error(
        source, fmt::format("the image has {} dimensions ({}), 3 are expected", dimensions, fmt::join(sizes, " × ")),
        "Export one 3D label mask; overlapping segments must be merged into one layer first.");
  }
  if (dimensions < 3 || std::any_of(sizes.begin(), sizes.begin() + 3, [](std::size_t n) { return n < 2; })) {
    return input_error(
        source,
        fmt::format("the image has {} voxels, at least 2 along each of 3 axes are needed", fmt::join(sizes, " × ")),
        "Export the whole volume, not one slice.");
  }
  return Ok{};
}

Result<LabelImage> to_label_image(const Voxels& voxels) {
  Result<> dimensions = check_dimensions(voxels.size, voxels.source);
  if (!dimensions) return dimensions.error();
  const double count =
      static_cast<double>(voxels.size[0]) * static_cast<double>(voxels.size[1]) * static_cast<double>(voxels.size[2]);
  if (count > std::numeric_limits<Index>::max()) {
    return input_error(voxels.source,
                       fmt::format("the image has {:.3g} voxels, at most {:.3g} are supported", count,
                                   static_cast<double>(std::numeric_limits<Index>::max())),
                       "Crop it to the pelvis.");
  }
  LabelImage image;
  image.source = voxels.source;
  for (int a = 0; a < 3; ++a) image.size[a] = static_cast<Index>(voxels.size[a]);
  Result<> frame = set_frame(voxels, image);
  if (!frame) return frame.error();
  image.labels.resize(static_cast<std::size_t>(count));
  Result<> labels = copy_labels(voxels, image);
  if (!labels) return labels.error();
  Result<> extent = check_extent(image);
  if (!extent) return extent.error();
  return image;
}

}  // namespace stylet::detail

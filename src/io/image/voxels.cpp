// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/voxels.hpp"

#include "detail/reach.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <unordered_set>
#include <vector>

namespace stylet::detail {

namespace {

// In a mask most neighbouring voxels have the same label, whereas grey values vary from voxel to voxel. An image with
// at most kFewValues different values is a mask, an image with more than kManyValues has grey values; between them the
// share of equal neighbours decides.
constexpr std::size_t kFewValues = 16;
constexpr std::size_t kManyValues = 256;
constexpr double kAlikeInMask = 1.0 / 3.0;   // least share of equal neighbours along i in a mask, without background
constexpr std::size_t kMostCounted = 65536;  // limit for counting different values for a message
constexpr double kExact = 1e-5;              // distance from a whole number that single precision explains
constexpr double kWhole = 0.01;              // largest distance of a label from a whole number
constexpr double kWholeScaled = 0.05;        // the same if the image is scaled in steps of at least twice this distance
constexpr double max_shear = 1e-3;           // largest |cosine| between two axes; headers have single precision

const char* const mask_cure =
    "Name a label mask: 0 outside, one whole number per structure; apply a threshold to a probability map first, e.g. "
    "in 3D Slicer";

/// The values of an image as numbers; T is their type in the file.
template <class T>
struct Values {
  const Voxels& voxels;
  double operator()(std::size_t n) const {
    return voxels.slope * static_cast<double>(static_cast<const T*>(voxels.data)[n]) + voxels.intercept;
  }
  /// Largest distance of a label from a whole number: a scaled label may be off by half a step.
  [[nodiscard]] double tolerance() const {
    return std::is_floating_point_v<T> ? kWhole : std::clamp(std::abs(voxels.slope) / 2 + kExact, kWhole, kWholeScaled);
  }
};

std::string voxel_name(const Voxels& voxels, std::size_t n) {
  const std::size_t nx = voxels.size[0], ny = voxels.size[1];
  return fmt::format("voxel ({}, {}, {})", n % nx, n / nx % ny, n / (nx * ny));
}

/// The error for an image with grey values; it gives the number and the range of its values.
template <class T>
Error is_picture(const Values<T>& value, std::size_t count, const std::string& why) {
  std::unordered_set<double> different;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t n = 0; n < count; ++n) {
    const double v = value(n);
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
    if (different.size() <= kMostCounted) different.insert(v);
  }
  const bool more = different.size() > kMostCounted;
  return input_error(value.voxels.source,
                     fmt::format("this is an image, not a mask: it has {}{} different values from {:.6g} to {:.6g}{}",
                                 more ? "more than " : "", more ? kMostCounted : different.size(), low, high, why),
                     mask_cure);
}

/// Whether labels with this number of different values look like grey values.
bool varies_like_picture(const std::vector<std::uint16_t>& labels, std::size_t different) {
  if (different <= kFewValues) return false;
  if (different > kManyValues) return true;
  std::size_t pairs = 0, alike = 0;
  for (std::size_t n = 1; n < labels.size(); ++n) {
    if (labels[n] == 0 && labels[n - 1] == 0) continue;
    ++pairs;
    if (labels[n] == labels[n - 1]) ++alike;
  }
  return static_cast<double>(alike) < kAlikeInMask * static_cast<double>(pairs);
}

/// Values of an image that are no labels.
struct Oddities {
  std::size_t not_numbers = 0;         ///< number of voxels that are NaN
  double negative = 0;                 ///< the only negative value, if the number of its voxels is not 0
  std::size_t negatives = 0;           ///< number of its voxels
  std::size_t zeros = 0;               ///< number of voxels that are 0
  double farthest = 0;                 ///< largest distance from a whole number
  std::size_t farthest_at = 0;         ///< its voxel
  std::optional<std::size_t> outside;  ///< the first voxel whose value is not a possible label
};

/// Adds notes on what was taken as background, and on values that were rounded.
template <class T>
void note_odd_values(const Oddities& odd, const Values<T>& value, std::vector<std::string>& notes) {
  const auto plural = [](std::size_t n) { return n == 1 ? "" : "s"; };
  if (odd.not_numbers > 0) {
    notes.push_back(fmt::format("{} voxel{} no number (NaN): taken as background.", odd.not_numbers,
                                odd.not_numbers == 1 ? " is" : "s are"));
  }
  if (odd.negatives > 0) {
    notes.push_back(fmt::format("The value {:g} of {} voxel{} is taken as background{}.", odd.negative, odd.negatives,
                                plural(odd.negatives), odd.zeros > 0 ? ", as 0 is" : ""));
  }
  if (odd.farthest > kExact) {
    notes.push_back(fmt::format("Labels are rounded to whole numbers; the farthest from one is {:.6g} at {}.",
                                value(odd.farthest_at), voxel_name(value.voxels, odd.farthest_at)));
  }
}

/// Copies values to labels; T is the file's type.
template <class T>
Result<> copy_labels(const Voxels& voxels, std::vector<std::uint16_t>& labels, std::vector<std::string>& notes) {
  const Values<T> value{voxels};
  const std::size_t count = labels.size();
  const double tolerance = value.tolerance();
  std::vector<bool> seen(std::numeric_limits<std::uint16_t>::max() + std::size_t{1});
  std::size_t different = 0;
  Oddities odd;
  std::optional<std::size_t> below;  // the first voxel with a negative value
  for (std::size_t n = 0; n < count; ++n) {
    const double v = value(n), whole = std::round(v);
    if (std::isnan(v)) {
      ++odd.not_numbers;
      continue;
    }
    if (!std::isfinite(v)) {
      return input_error(fmt::format("{}, {}", voxels.source, voxel_name(voxels, n)),
                         fmt::format("the value is {}, a whole number is expected", v), mask_cure);
    }
    if (std::abs(v - whole) > odd.farthest) {
      odd.farthest = std::abs(v - whole);
      odd.farthest_at = n;
    }
    if (std::abs(v - whole) > tolerance) {
      return is_picture(value, count,
                        fmt::format(", and {:.6g} at {} is not a whole number", v, voxel_name(voxels, n)));
    }
    if (whole < 0 && (odd.negatives == 0 || whole == odd.negative)) {
      if (!below) below = n;
      odd.negative = whole;
      ++odd.negatives;
      continue;
    }
    if (whole < 0 || whole > std::numeric_limits<std::uint16_t>::max()) {
      if (!odd.outside) odd.outside = whole < 0 ? below : n;
      continue;
    }
    if (whole == 0) ++odd.zeros;
    labels[n] = static_cast<std::uint16_t>(whole);
    if (!seen[labels[n]]) ++different;
    seen[labels[n]] = true;
  }
  const bool shows_something = different > (odd.zeros > 0 ? 1U : 0U);
  if (below && ((odd.negative != -1 && odd.zeros > 0) || !shows_something)) odd.outside = odd.outside.value_or(*below);
  if (odd.outside) {
    return is_picture(value, count,
                      fmt::format(", and {:.6g} at {} is not a label (0…65535)", value(*odd.outside),
                                  voxel_name(voxels, *odd.outside)));
  }
  if (odd.not_numbers > 0 && !shows_something) {
    return input_error(voxels.source,
                       fmt::format("the mask is empty: {} voxels are nan, all others 0", odd.not_numbers), mask_cure);
  }
  if (varies_like_picture(labels, different)) return is_picture(value, count, "");
  note_odd_values(odd, value, notes);
  return Ok{};
}

Result<> copy_labels(const Voxels& voxels, std::vector<std::uint16_t>& labels, std::vector<std::string>& notes) {
  switch (voxels.type) {
    case VoxelType::int8:
      return copy_labels<std::int8_t>(voxels, labels, notes);
    case VoxelType::uint8:
      return copy_labels<std::uint8_t>(voxels, labels, notes);
    case VoxelType::int16:
      return copy_labels<std::int16_t>(voxels, labels, notes);
    case VoxelType::uint16:
      return copy_labels<std::uint16_t>(voxels, labels, notes);
    case VoxelType::int32:
      return copy_labels<std::int32_t>(voxels, labels, notes);
    case VoxelType::uint32:
      return copy_labels<std::uint32_t>(voxels, labels, notes);
    case VoxelType::int64:
      return copy_labels<std::int64_t>(voxels, labels, notes);
    case VoxelType::uint64:
      return copy_labels<std::uint64_t>(voxels, labels, notes);
    case VoxelType::float32:
      return copy_labels<float>(voxels, labels, notes);
    case VoxelType::float64:
      return copy_labels<double>(voxels, labels, notes);
  }
  return Ok{};
}

}  // namespace

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
    return input_error(image.source, "the mask is empty: every voxel is 0", "Segment a structure before exporting");
  }
  double extent = 0.0;
  for (int a = 0; a < 3; ++a) extent = std::max(extent, (high[a] - low[a] + 1) * image.spacing[a]);
  if (extent < 1.0 || extent > 2000.0) {
    return input_error(image.source,
                       fmt::format("the segmentation is {:.4g} mm long, 1 mm to 2 m is expected; voxel spacing "
                                   "{:.4g} × {:.4g} × {:.4g} mm",
                                   extent, image.spacing[0], image.spacing[1], image.spacing[2]),
                       "Correct the voxel spacing; the unit of the file is probably not mm");
  }
  return Ok{};
}

std::size_t bytes_in(VoxelType type) {
  switch (type) {
    case VoxelType::int8:
    case VoxelType::uint8:
      return 1;
    case VoxelType::int16:
    case VoxelType::uint16:
      return 2;
    case VoxelType::int32:
    case VoxelType::uint32:
    case VoxelType::float32:
      return 4;
    case VoxelType::int64:
    case VoxelType::uint64:
    case VoxelType::float64:
      return 8;
  }
  return 0;
}

std::optional<std::string> fault_of_axes(const Mat3& axes) {
  for (int a = 0; a < 3; ++a) {
    if (const double length = axes.col(a).norm(); !(std::isfinite(length) && length > 0))
      return fmt::format("the step along the image axis {} is {:g} long", "ijk"[a], length);
  }
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 3; ++b) {
      const double cosine = axes.col(a).normalized().dot(axes.col(b).normalized());
      if (std::abs(cosine) > max_shear) {
        return fmt::format("the image axes {} and {} enclose {:.2f}°, 90° is expected (a sheared image)", "ijk"[a],
                           "ijk"[b], std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / M_PI);
      }
    }
  }
  return std::nullopt;
}

Result<> set_frame(const Voxels& voxels, LabelImage& image) {
  const char* const cure = "Write the image again with a valid orientation, in mm, e.g. from 3D Slicer";
  const std::array<std::size_t, 3>& size = voxels.size;
  const double count = static_cast<double>(size[0]) * static_cast<double>(size[1]) * static_cast<double>(size[2]);
  if (count > std::numeric_limits<Index>::max()) {
    return input_error(voxels.source,
                       fmt::format("the image has {:.3g} voxels, at most {:.3g} are supported", count,
                                   static_cast<double>(std::numeric_limits<Index>::max())),
                       "Crop it to the pelvis");
  }
  if (Result<> reach = check_reach(fmt::format("{}, {}", voxels.source, voxels.origin_field), voxels.origin,
                                   "the image's first voxel");
      !reach) {
    return reach;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::string where = fmt::format("{}, {}", voxels.source, voxels.spacing_field);
    const double length = voxels.axes.col(axis).norm();
    if (!(length >= kFinestVoxel_mm && length <= kCoarsestVoxel_mm)) {
      return input_error(where,
                         fmt::format("the voxel spacing along axis {} is {:.6g} mm, {:g} to {:g} mm is expected",
                                     "ijk"[axis], length, kFinestVoxel_mm, kCoarsestVoxel_mm),
                         cure);
    }
    if (length * static_cast<double>(size[axis]) > kLongestImage_mm) {
      return input_error(
          where,
          fmt::format("the image is {:.6g} mm long along axis {} ({} voxels of {:.6g} mm), at most {:g} "
                      "mm is expected",
                      length * static_cast<double>(size[axis]), "ijk"[axis], size[axis], length, kLongestImage_mm),
          cure);
    }
    image.spacing[axis] = length;
    image.direction.col(axis) = voxels.axes.col(axis) / length;
  }
  if (const auto fault = fault_of_axes(voxels.axes)) {
    return input_error(voxels.source, *fault, "Resample the mask to a regular grid, e.g. with 3D Slicer");
  }
  image.source = voxels.source;
  image.origin = voxels.origin;
  for (int a = 0; a < 3; ++a) image.size[a] = static_cast<Index>(size[a]);
  return Ok{};
}

Result<std::vector<std::uint16_t>> labels_of(const Voxels& voxels, std::vector<std::string>& notes) {
  std::vector<std::uint16_t> labels(voxels.size[0] * voxels.size[1] * voxels.size[2]);
  if (Result<> copied = copy_labels(voxels, labels, notes); !copied) return copied.error();
  return labels;
}

Result<std::size_t> choose_volume(std::span<const std::size_t> sizes, int chosen, const std::string& source) {
  if (sizes.size() < 3 || std::any_of(sizes.begin(), sizes.begin() + 3, [](std::size_t n) { return n < 2; })) {
    return input_error(
        source,
        fmt::format("the image has {} voxels, at least 2 along each of 3 axes are needed", fmt::join(sizes, " × ")),
        "Export the whole volume, not one slice");
  }
  double volumes = 1;
  for (const std::size_t n : sizes.subspan(3)) volumes *= static_cast<double>(std::max<std::size_t>(n, 1));
  if (volumes == 1 && chosen <= 1) return std::size_t{0};
  if (chosen == 0) {
    return input_error(
        source,
        fmt::format("the file holds {:.0f} volumes ({} voxels), one is needed", volumes, fmt::join(sizes, " × ")),
        "Choose one, counted from 1: volume = 1 below [patient] in a scenario, --volume 1 with stylet info and stylet "
        "mesh");
  }
  if (chosen > volumes) {
    return input_error(
        source,
        fmt::format("volume {} is chosen, the file holds {:.0f} ({} voxels)", chosen, volumes, fmt::join(sizes, " × ")),
        volumes == 1 ? "Leave volume out" : fmt::format("Choose one from 1 to {:.0f}", volumes));
  }
  return static_cast<std::size_t>(chosen - 1);
}

Result<LabelImage> to_label_image(const Voxels& voxels) {
  LabelImage image;
  if (Result<> frame = set_frame(voxels, image); !frame) return frame.error();
  image.notes = voxels.notes;
  Result<std::vector<std::uint16_t>> labels = labels_of(voxels, image.notes);
  if (!labels) return labels.error();
  image.labels = std::move(*labels);
  if (Result<> extent = check_extent(image); !extent) return extent.error();
  return image;
}

}  // namespace stylet::detail

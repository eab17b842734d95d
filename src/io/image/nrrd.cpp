// SPDX-License-Identifier: GPL-3.0-or-later
// NRRD, also 3D Slicer's .seg.nrrd, by Teem (the format's own library).
#include "detail/parsers.hpp"
#include "detail/text.hpp"
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <teem/nrrd.h>

#include <memory>

namespace stylet::detail {

namespace {

struct NrrdCloser {
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
};
using NrrdPointer = std::unique_ptr<Nrrd, NrrdCloser>;

/// Teem's own words for its last error, the innermost line.
std::string last_error() {
  char* text = biffGetDone(NRRD);
  const std::string all = text == nullptr ? "" : text;
  std::free(text);
  std::string innermost;
  for (const auto line : split(all, '\n')) {
    if (!trimmed(line).empty()) innermost = trimmed(line);
  }
  const auto end = innermost.find(": ");
  return end == std::string::npos ? innermost : innermost.substr(end + 2);
}

Result<VoxelType> voxel_type(int type, const std::string& source) {
  switch (type) {
    case nrrdTypeChar:
      return VoxelType::int8;
    case nrrdTypeUChar:
      return VoxelType::uint8;
    case nrrdTypeShort:
      return VoxelType::int16;
    case nrrdTypeUShort:
      return VoxelType::uint16;
    case nrrdTypeInt:
      return VoxelType::int32;
    case nrrdTypeUInt:
      return VoxelType::uint32;
    case nrrdTypeLLong:
      return VoxelType::int64;
    case nrrdTypeULLong:
      return VoxelType::uint64;
    case nrrdTypeFloat:
      return VoxelType::float32;
    case nrrdTypeDouble:
      return VoxelType::float64;
    default:
      return input_error(source, fmt::format("the voxel type '{}' is not supported", airEnumStr(nrrdType, type)),
                         "Export the mask as 8- or 16-bit whole numbers.");
  }
}

/// Signs that turn the file's space into LPS.
Result<Vec3> to_lps(const Nrrd& nrrd, const std::string& source) {
  switch (nrrd.space) {
    case nrrdSpaceLeftPosteriorSuperior:
      return Vec3(1, 1, 1);
    case nrrdSpaceRightAnteriorSuperior:
      return Vec3(-1, -1, 1);
    case nrrdSpaceLeftAnteriorSuperior:
      return Vec3(1, -1, 1);
    default:
      return input_error(
          source,
          nrrd.space == nrrdSpaceUnknown
              ? std::string("the header does not say how the image lies in the patient (no 'space')")
              : fmt::format("the space '{}' is not one of the patient's", airEnumStr(nrrdSpace, nrrd.space)),
          "Write 'space: left-posterior-superior' (or right-anterior-superior, left-anterior-superior), "
          "'space directions' and 'space origin'.");
  }
}

/// [mm] per unit; 0 when unknown.
double unit_mm(const char* unit) {
  const std::string name = unit == nullptr ? "" : lower(trimmed(unit));
  if (name.empty() || name == "mm" || name == "millimeter" || name == "millimetre") return 1.0;
  if (name == "cm") return 10.0;
  if (name == "m") return 1000.0;
  if (name == "um" || name == "µm") return 0.001;
  return 0.0;
}

std::optional<std::string> key_value(const Nrrd& nrrd, const std::string& key) {
  char* text = nrrdKeyValueGet(&nrrd, key.c_str());
  if (text == nullptr) return std::nullopt;
  std::string value = trimmed(text);
  std::free(text);
  return value;
}

/// Names of 3D Slicer's segments: keys SegmentN_Name and SegmentN_LabelValue.
std::map<int, std::string> segment_names(const Nrrd& nrrd) {
  std::map<int, std::string> names;
  for (int n = 0; n < 65536; ++n) {
    const auto name = key_value(nrrd, fmt::format("Segment{}_Name", n));
    if (!name) break;
    const auto label = key_value(nrrd, fmt::format("Segment{}_LabelValue", n));
    const double value = label ? to_number(*label).value_or(0.0) : n + 1;
    if (value >= 1 && value <= 65535) names[static_cast<int>(value)] = *name;
  }
  return names;
}

Result<> check_layers(const Nrrd& nrrd, const std::string& source) {
  std::vector<std::size_t> sizes;
  for (unsigned d = 0; d < nrrd.dim; ++d) sizes.push_back(nrrd.axis[d].size);
  if (nrrd.dim == 4 && nrrd.axis[0].size > 1 && nrrd.axis[0].kind == nrrdKindList) {
    return input_error(
        source, fmt::format("the segmentation has {} layers because its segments overlap, one is expected", sizes[0]),
        "In 3D Slicer let the segments not overlap (Segment Editor, Masking, Overwrite all) and collapse the "
        "layers, or export to one label map.");
  }
  return check_dimensions(sizes, source);
}

}  // namespace

Result<LabelImage> parse_nrrd(const std::filesystem::path& path) {
  const std::string source = path.string();
  const auto damaged = [&] {
    return input_error(source, fmt::format("the NRRD file cannot be read ({})", last_error()),
                       "Copy or export it again; it is truncated or damaged.");
  };
  // The header first: a refusal must not wait for gigabytes, and says more than a failure in the data.
  const std::unique_ptr<NrrdIoState, NrrdIoState* (*)(NrrdIoState*)> header_only(nrrdIoStateNew(), nrrdIoStateNix);
  nrrdIoStateSet(header_only.get(), nrrdIoStateSkipData, AIR_TRUE);
  NrrdPointer nrrd(nrrdNew());
  if (nrrdLoad(nrrd.get(), path.c_str(), header_only.get()) != 0) return damaged();
  Result<> layers = check_layers(*nrrd, source);
  if (!layers) return layers.error();
  Result<Vec3> lps = to_lps(*nrrd, source);
  if (!lps) return lps.error();

  nrrd.reset(nrrdNew());
  if (nrrdLoad(nrrd.get(), path.c_str(), nullptr) != 0) return damaged();
  Result<VoxelType> type = voxel_type(nrrd->type, source);
  if (!type) return type.error();

  Voxels voxels;
  voxels.source = source;
  voxels.type = *type;
  voxels.data = nrrd->data;
  const unsigned first = nrrd->dim == 4 && nrrd->axis[0].size == 1 ? 1 : 0;  // one layer written as a list of one
  for (unsigned a = 0; a < 3; ++a) {
    const NrrdAxisInfo& axis = nrrd->axis[first + a];
    const double unit = unit_mm(nrrd->spaceUnits[a]);
    if (unit == 0.0) {
      return input_error(source, fmt::format("the unit '{}' is unknown", nrrd->spaceUnits[a]),
                         "Write 'space units: \"mm\" \"mm\" \"mm\"'.");
    }
    voxels.size[a] = axis.size;
    for (unsigned row = 0; row < 3; ++row) {
      voxels.axes(row, a) = (*lps)[row] * unit_mm(nrrd->spaceUnits[row]) * axis.spaceDirection[row];
    }
    voxels.origin[a] = (*lps)[a] * unit * nrrd->spaceOrigin[a];
  }
  Result<LabelImage> image = to_label_image(voxels);
  if (image) image->names = segment_names(*nrrd);
  return image;
}

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
// MetaImage, by MetaIO (the format's own library, part of VTK). Its frame is LPS, as ITK reads and writes it.
#include "detail/parsers.hpp"
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <vtkmetaio/metaImage.h>

namespace stylet::detail {

using namespace vtkmetaio;  // NOLINT(google-build-using-namespace): where VTK keeps MetaIO

namespace {

Result<VoxelType> voxel_type(MetaImage& image, const std::string& source) {
  switch (image.ElementType()) {
    case MET_CHAR:
    case MET_ASCII_CHAR:
      return VoxelType::int8;
    case MET_UCHAR:
      return VoxelType::uint8;
    case MET_SHORT:
      return VoxelType::int16;
    case MET_USHORT:
      return VoxelType::uint16;
    case MET_INT:
      return VoxelType::int32;
    case MET_UINT:
      return VoxelType::uint32;
    case MET_LONG:
      return sizeof(MET_LONG_TYPE) == 8 ? VoxelType::int64 : VoxelType::int32;
    case MET_ULONG:
      return sizeof(MET_ULONG_TYPE) == 8 ? VoxelType::uint64 : VoxelType::uint32;
    case MET_LONG_LONG:
      return VoxelType::int64;
    case MET_ULONG_LONG:
      return VoxelType::uint64;
    case MET_FLOAT:
      return VoxelType::float32;
    case MET_DOUBLE:
      return VoxelType::float64;
    default:
      return input_error(source,
                         fmt::format("the voxel type {} is not supported", MET_ValueTypeName[image.ElementType()]),
                         "Export the mask as MET_UCHAR or MET_USHORT.");
  }
}

double unit_mm(MET_DistanceUnitsEnumType unit) {
  switch (unit) {
    case MET_DISTANCE_UNITS_CM:
      return 10.0;
    case MET_DISTANCE_UNITS_UM:
      return 0.001;
    default:
      return 1.0;
  }
}

}  // namespace

Result<LabelImage> parse_metaimage(const std::filesystem::path& path) {
  const std::string source = path.string();
  const auto damaged = [&](const char* part) {
    return input_error(
        source, fmt::format("the {} of the MetaImage file cannot be read", part),
        "Copy or export it again (an .mhd header needs its data file beside it); it is truncated or damaged.");
  };
  MetaImage image;
  // The header first: a refusal must not wait for gigabytes, and says more than a failure in the data.
  if (!image.Read(path.c_str(), false)) return damaged("header");
  std::vector<std::size_t> sizes;
  for (int d = 0; d < image.NDims(); ++d) sizes.push_back(static_cast<std::size_t>(std::max(image.DimSize(d), 0)));
  Result<> three = check_dimensions(sizes, source);
  if (!three) return three.error();
  if (image.ElementNumberOfChannels() != 1) {
    return input_error(source, fmt::format("a voxel has {} components, 1 is expected", image.ElementNumberOfChannels()),
                       "Export a label mask, not a colour or vector image.");
  }
  Result<VoxelType> type = voxel_type(image, source);
  if (!type) return type.error();

  if (!image.Read(path.c_str(), true) || image.ElementData() == nullptr) return damaged("data");
  image.ElementByteOrderFix();

  Voxels voxels;
  voxels.source = source;
  voxels.type = *type;
  voxels.data = image.ElementData();
  const double unit = unit_mm(image.DistanceUnits());
  const int dimensions = image.NDims();
  for (int a = 0; a < 3; ++a) {
    voxels.size[a] = sizes[a];
    // Row a of TransformMatrix is the direction of image axis a.
    for (int row = 0; row < 3; ++row) {
      voxels.axes(row, a) = unit * image.TransformMatrix()[a * dimensions + row] * image.ElementSpacing(a);
    }
    voxels.origin[a] = unit * image.Offset()[a];
  }
  return to_label_image(voxels);
}

}  // namespace stylet::detail

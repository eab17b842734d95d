// SPDX-License-Identifier: GPL-3.0-or-later
// MetaImage; the header by MetaIO (the format's own library, part of VTK). Its frame is LPS, as ITK reads and writes
// it.
#include "detail/parsers.hpp"
#include "detail/text.hpp"
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <vtkmetaio/metaImage.h>
#include <zlib.h>

#include <fstream>
#include <iterator>

namespace stylet::detail {

namespace fs = std::filesystem;
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

/// Where the voxels of a file with header and data in one begin: after the line "ElementDataFile = LOCAL".
std::size_t end_of_header(const std::string& text) {
  const auto key = text.find("ElementDataFile");
  const auto line_end = key == std::string::npos ? key : text.find('\n', key);
  return line_end == std::string::npos ? text.size() : line_end + 1;
}

/// zlib or gzip to exactly `size` bytes; shorter when the data end too early.
std::string inflated(std::string_view packed, std::size_t size) {
  std::string out(size, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 32) != Z_OK) return {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  std::size_t in_left = packed.size(), out_left = size;
  int status = Z_OK;
  while (status == Z_OK && out_left > 0) {  // zlib counts in 32 bits
    stream.avail_in = static_cast<uInt>(std::min<std::size_t>(in_left, 1 << 30));
    stream.avail_out = static_cast<uInt>(std::min<std::size_t>(out_left, 1 << 30));
    const std::size_t in_given = stream.avail_in, out_given = stream.avail_out;
    status = inflate(&stream, Z_NO_FLUSH);
    in_left -= in_given - stream.avail_in;
    out_left -= out_given - stream.avail_out;
  }
  inflateEnd(&stream);
  out.resize(size - out_left);
  return out;
}

/// The voxels' bytes as the file orders them. MetaIO itself leaves voxels uninitialised where a file ends too early.
Result<std::string> read_voxels(const fs::path& path, MetaImage& image, std::size_t size) {
  const std::string source = path.string();
  const std::string name = image.ElementDataFileName();
  const bool local = lower(name) == "local";
  if (!image.BinaryData() || lower(name).starts_with("list") || name.find('%') != std::string::npos) {
    return input_error(source, "voxels as text or in many files are not supported", "Export one binary .mha file.");
  }
  const fs::path data_path = local ? path : path.parent_path() / name;
  std::ifstream file(data_path, std::ios::binary);
  if (!file || fs::is_directory(data_path)) {
    return input_error(source, fmt::format("its data file '{}' cannot be opened", name),
                       "Keep header and data beside each other.");
  }
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  std::size_t start = local ? end_of_header(bytes) : static_cast<std::size_t>(std::max(image.HeaderSize(), 0));
  if (image.HeaderSize() < 0 && !image.CompressedData() && bytes.size() >= size)
    start = bytes.size() - size;  // "-1": at the end
  bytes.erase(0, std::min(start, bytes.size()));
  if (image.CompressedData()) bytes = inflated(bytes, size);
  if (bytes.size() < size) {
    return input_error(source, fmt::format("there are {} bytes of voxels, {} are expected", bytes.size(), size),
                       "Copy or export it again; it is truncated or damaged.");
  }
  return bytes;
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

  int voxel_bytes = 0;
  MET_SizeOfType(image.ElementType(), &voxel_bytes);
  const double bytes = static_cast<double>(voxel_bytes) * static_cast<double>(sizes[0]) *
                       static_cast<double>(sizes[1]) * static_cast<double>(sizes[2]);
  if (bytes > 1e12) return damaged("size");
  Result<std::string> data = read_voxels(path, image, static_cast<std::size_t>(bytes));
  if (!data) return data.error();
  image.ElementData(data->data(), false);
  image.ElementByteOrderFix(static_cast<std::streamoff>(bytes) / voxel_bytes);

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

// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of MetaImage; MetaIO (the format's own library, part of VTK) reads the header. The file's frame is LPS, as in
// ITK.
#include "detail/input_file.hpp"
#include "detail/parsers.hpp"
#include "detail/text.hpp"
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkmetaio/metaImage.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <set>
#include <vector>

namespace stylet::detail {

namespace fs = std::filesystem;
using namespace vtkmetaio;  // NOLINT(google-build-using-namespace): VTK's namespace for MetaIO

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
                         "Export the mask as MET_UCHAR or MET_USHORT");
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

/// Unpacks zlib or gzip data to `size` bytes; fewer if the data end too early.
std::string inflated(std::string_view packed, std::size_t size) {
  std::string out(size, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 32) != Z_OK) return {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  std::size_t in_left = packed.size(), out_left = size;
  int status = Z_OK;
  while (status == Z_OK && out_left > 0) {  // in portions, because zlib counts bytes in 32 bits
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

/// The fields of the header that must be checked before MetaIO reads it: MetaIO uses NDims as the length of lists that
/// have room for ten numbers, and opens any data file.
struct Announced {
  double dimensions = 0;
  std::string data_file;
  std::size_t header_bytes = 0;  ///< position of the voxels in a file with header and data
  std::set<std::string> keys;    ///< all keys of the header
};

/// Error if the header does not say where the image lies, how it is turned or how large its voxels are; MetaIO would
/// put its first voxel at 0, along the axes of the patient, with 1 mm.
Result<> check_place(const std::set<std::string>& keys, const std::string& source) {
  const auto has = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return keys.contains(name); });
  };
  std::vector<const char*> missing;
  if (!has({"Offset", "Position", "Origin"})) missing.push_back("Offset");
  if (!has({"TransformMatrix", "Rotation", "Orientation"})) missing.push_back("TransformMatrix");
  if (!has({"ElementSpacing", "ElementSize"})) missing.push_back("ElementSpacing");
  if (missing.empty()) return Ok{};
  return input_error(source,
                     fmt::format("the header does not state the position of the image in the patient (no {})",
                                 fmt::join(missing, ", no ")),
                     "Save the image again with its orientation, e.g. from 3D Slicer; without it left and right are "
                     "unknown");
}

/// Reads these fields. MetaIO separates key and value at '=' or ':', whichever comes first, and knows its keys in one
/// spelling only. A header in which MetaIO might see other lines than this function is an error.
Result<Announced> announced_in(const fs::path& path) {
  const std::string source = path.string();
  constexpr std::size_t kLongest = 4095, kRoom = 254;
  std::ifstream file(path, std::ios::binary);
  Announced found;
  for (int number = 1;; ++number) {
    const std::optional<HeaderLine> line = next_header_line(file);
    if (!line) break;
    const auto separator = line->text.find_first_of("=:");
    const std::string key = trimmed(line->text.substr(0, separator));
    if (separator == std::string::npos && key.empty() && !line->lone_return) continue;
    const char* wrong = nullptr;
    if (line->text.size() > kLongest) wrong = "it is longer than 4095 characters";
    if (line->lone_return) wrong = "it ends in a carriage return alone";
    if (separator == std::string::npos || key.empty()) wrong = "it is not of the form KEY = VALUE";
    if (key.size() > kRoom) wrong = "its key has more than 254 characters";
    if (wrong != nullptr) {
      return input_error(fmt::format("{}, line {}", source, number),
                         fmt::format("the header of the MetaImage file is damaged: {}", wrong),
                         "Copy or export it again");
    }
    const std::string value = trimmed(line->text.substr(separator + 1));
    // MetaIO copies these texts, and all keys, into 255 bytes each.
    constexpr std::array<std::string_view, 4> kShort{"Comment", "Name", "ObjectType", "ObjectSubType"};
    if (value.size() > kRoom && std::find(kShort.begin(), kShort.end(), key) != kShort.end()) {
      return input_error(fmt::format("{}, line {}", source, number),
                         fmt::format("{} has {} characters, at most {} are expected", key, value.size(), kRoom),
                         "Shorten it, or save the image again without it");
    }
    found.keys.insert(key);
    if (key == "NDims") {
      found.dimensions = to_number(value).value_or(0);
      if (!(found.dimensions >= 2 && found.dimensions <= 5)) {
        return input_error(source + ", NDims", fmt::format("the value is '{}', 3 is expected", value.substr(0, 40)),
                           "The header is damaged; export one 3D label mask");
      }
    }
    if (key == "ElementDataFile") {  // always the last line of a header
      found.data_file = value;
      found.header_bytes = static_cast<std::size_t>(file.tellg());
      break;
    }
  }
  if (found.dimensions == 0 || found.data_file.empty()) {
    return input_error(
        source,
        fmt::format("the header of the MetaImage file has no {}", found.dimensions == 0 ? "NDims" : "ElementDataFile"),
        "The file is truncated or damaged; copy or export it again");
  }
  return found;
}

/// The file with the voxels. Errors: a list or a pattern of files; errors of data_file_of().
Result<fs::path> voxel_file(const fs::path& path, const std::string& name) {
  if (lower(name) == "local") return path;
  if (lower(name).starts_with("list") || name.find('%') != std::string::npos) {
    return input_error(path.string() + ", ElementDataFile",
                       fmt::format("'{}': voxels spread over many files are not supported", name.substr(0, 80)),
                       "Export one binary .mha file");
  }
  return data_file_of(path, name);
}

/// Reads the bytes of the voxels in the file's order. MetaIO is not used here, because it leaves voxels uninitialised
/// if the file ends too early.
Result<std::string> read_voxels(const fs::path& path, const fs::path& data_path, std::size_t header_bytes,
                                MetaImage& image, std::size_t size) {
  const std::string source = path.string();
  if (!image.BinaryData()) {
    return input_error(source, "voxels as text are not supported", "Export one binary .mha file");
  }
  const bool local = data_path == path;
  std::ifstream file(data_path, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  std::size_t start = local ? header_bytes : static_cast<std::size_t>(std::max(image.HeaderSize(), 0));
  if (image.HeaderSize() < 0 && !image.CompressedData() && bytes.size() >= size)
    start = bytes.size() - size;  // header size -1 means that the voxels are at the end
  bytes.erase(0, std::min(start, bytes.size()));
  if (image.CompressedData()) bytes = inflated(bytes, size);
  if (bytes.size() < size) {
    return input_error(source, fmt::format("there are {} bytes of voxels, {} are expected", bytes.size(), size),
                       "The file is truncated or damaged; copy or export it again");
  }
  return bytes;
}

}  // namespace

Result<LabelImage> parse_metaimage(const std::filesystem::path& path, const MaskReadOptions& options) {
  const std::string source = path.string();
  const auto damaged = [&](const char* part) {
    return input_error(source, fmt::format("the {} of the MetaImage file cannot be read", part),
                       "The file is truncated or damaged; copy or export it again (an .mhd header needs its data file "
                       "in the same folder)");
  };
  const Result<Announced> announced = announced_in(path);
  if (!announced) return announced.error();
  if (Result<> placed = check_place(announced->keys, source); !placed) return placed.error();
  const Result<fs::path> data_path = voxel_file(path, announced->data_file);
  if (!data_path) return data_path.error();
  MetaImage image;
  // Read the header first, so that an error does not need gigabytes of data to be read, and is more precise.
  if (!image.Read(path.c_str(), false)) return damaged("header");
  std::vector<std::size_t> sizes;
  for (int d = 0; d < image.NDims(); ++d) sizes.push_back(static_cast<std::size_t>(std::max(image.DimSize(d), 0)));
  const Result<std::size_t> volume = choose_volume(sizes, options.volume, source);
  if (!volume) return volume.error();
  if (image.ElementNumberOfChannels() != 1) {
    return input_error(source, fmt::format("a voxel has {} components, 1 is expected", image.ElementNumberOfChannels()),
                       "Export a label mask, not a colour or vector image");
  }
  Result<VoxelType> type = voxel_type(image, source);
  if (!type) return type.error();

  int voxel_bytes = 0;
  MET_SizeOfType(image.ElementType(), &voxel_bytes);
  double count = 1;
  for (const std::size_t n : sizes) count *= static_cast<double>(n);
  if (count * voxel_bytes > 1e12) return damaged("size");
  Result<std::string> data =
      read_voxels(path, *data_path, announced->header_bytes, image, static_cast<std::size_t>(count) * voxel_bytes);
  if (!data) return data.error();
  image.ElementData(data->data(), false);
  image.ElementByteOrderFix(static_cast<std::streamoff>(count));

  Voxels voxels;
  voxels.source = source;
  voxels.type = *type;
  voxels.data = data->data() + *volume * sizes[0] * sizes[1] * sizes[2] * static_cast<std::size_t>(voxel_bytes);
  voxels.origin_field = "Offset";
  voxels.spacing_field = "ElementSpacing";
  const double unit = unit_mm(image.DistanceUnits());
  const int dimensions = image.NDims();
  for (int a = 0; a < 3; ++a) {
    voxels.size[a] = sizes[a];
    if (!(image.ElementSpacing(a) > 0)) {
      return input_error(source + ", ElementSpacing",
                         fmt::format("the value along axis {} is {:g}, a number above 0 is expected", "ijk"[a],
                                     image.ElementSpacing(a)),
                         "Write the image again with its voxel spacing in mm, e.g. from 3D Slicer");
    }
    // Row a of TransformMatrix is the direction of image axis a.
    for (int row = 0; row < 3; ++row) {
      voxels.axes(row, a) = unit * image.TransformMatrix()[a * dimensions + row] * image.ElementSpacing(a);
    }
    voxels.origin[a] = unit * image.Offset()[a];
  }
  return to_label_image(voxels);
}

}  // namespace stylet::detail

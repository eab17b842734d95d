// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of NIfTI-1 and NIfTI-2 with VTK. World coordinates of the file are RAS and are converted to LPS.
#include "detail/parsers.hpp"
#include "detail/vtk_messages.hpp"
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

namespace stylet::detail {

namespace {

Result<VoxelType> voxel_type(vtkImageData& image, const std::string& source) {
  switch (image.GetScalarType()) {
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
      return VoxelType::int8;
    case VTK_UNSIGNED_CHAR:
      return VoxelType::uint8;
    case VTK_SHORT:
      return VoxelType::int16;
    case VTK_UNSIGNED_SHORT:
      return VoxelType::uint16;
    case VTK_INT:
      return VoxelType::int32;
    case VTK_UNSIGNED_INT:
      return VoxelType::uint32;
    case VTK_LONG:
    case VTK_LONG_LONG:
      return VoxelType::int64;
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG:
      return VoxelType::uint64;
    case VTK_FLOAT:
      return VoxelType::float32;
    case VTK_DOUBLE:
      return VoxelType::float64;
    default:
      return input_error(source, "the voxel type is not supported", "Export the mask as 8- or 16-bit whole numbers");
  }
}

/// Length [mm] of the unit that the header states; 0 for a code that the standard does not have.
double unit_mm(int code) {
  switch (code & 0x07) {
    case 0:  // not stated; by convention mm
    case 2:
      return 1.0;
    case 1:
      return 1000.0;
    case 3:
      return 0.001;
    default:
      return 0.0;
  }
}

/// One component of all voxels of an image with interleaved components.
std::vector<char> component_of(vtkImageData& image, std::size_t component) {
  const std::size_t bytes = static_cast<std::size_t>(image.GetScalarSize());
  const std::size_t step = bytes * static_cast<std::size_t>(image.GetNumberOfScalarComponents());
  const auto* from = static_cast<const char*>(image.GetScalarPointer()) + component * bytes;
  std::vector<char> values(static_cast<std::size_t>(image.GetNumberOfPoints()) * bytes);
  for (std::size_t n = 0; n < values.size(); n += bytes, from += step) std::copy(from, from + bytes, &values[n]);
  return values;
}

/// Whether the file, unpacked, has at least `wanted` bytes. VTK would silently replace missing bytes by zeros.
bool holds_bytes(const std::filesystem::path& path, double wanted) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) return false;
  std::vector<char> buffer(1 << 20);
  double found = 0.0;
  while (found < wanted) {
    const int got = gzread(file.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
    if (got <= 0) return false;
    found += got;
  }
  return true;
}

}  // namespace

Result<LabelImage> parse_nifti(const std::filesystem::path& path, const MaskReadOptions& options) {
  const std::string source = path.string();
  const auto messages = VtkMessages::install();
  const auto damaged = [&] {
    return input_error(source, fmt::format("the NIfTI file cannot be read ({})", messages->first_error()),
                       "The file is truncated or damaged; copy or export it again");
  };
  vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(path.c_str());
  reader->TimeAsVectorOn();  // the volumes of a series become components, one of which is used
  reader->UpdateInformation();
  if (messages->failed()) return damaged();
  vtkNIFTIImageHeader& header = *reader->GetNIFTIHeader();

  std::vector<std::size_t> sizes;
  const int dimensions = static_cast<int>(std::clamp<vtkTypeInt64>(header.GetDim(0), 0, 7));
  for (int d = 1; d <= dimensions; ++d)
    sizes.push_back(static_cast<std::size_t>(std::max<vtkTypeInt64>(header.GetDim(d), 0)));
  const Result<std::size_t> volume = choose_volume(sizes, options.volume, source);
  if (!volume) return volume.error();
  for (int a = 1; a <= 3; ++a) {
    if (header.GetPixDim(a) >= 0 && std::isfinite(header.GetPixDim(a))) continue;
    return input_error(fmt::format("{}, pixdim[{}]", source, a),
                       fmt::format("the value is {:g}, a voxel spacing above 0 is expected", header.GetPixDim(a)),
                       "Save the image again, e.g. from 3D Slicer");
  }

  // The standard's method 3 (sform) has priority over method 2 (qform). VTK's matrices apply to index × spacing.
  vtkMatrix4x4* form = header.GetSFormCode() > 0 ? reader->GetSFormMatrix() : nullptr;
  if (form == nullptr && header.GetQFormCode() > 0) form = reader->GetQFormMatrix();
  if (form == nullptr) {
    return input_error(
        source, "the file does not state the position of the image in the patient (neither sform nor qform)",
        "Save the image again with its orientation, e.g. from 3D Slicer; without it left and right are unknown");
  }
  const double unit = unit_mm(header.GetXYZTUnits());
  if (unit == 0.0) {
    return input_error(source, fmt::format("the unit of length (code {}) is unknown", header.GetXYZTUnits() & 0x07),
                       "Set xyzt_units to 2 (mm)");
  }

  if (!std::string_view(header.GetMagic()).starts_with("n+")) {
    return input_error(source, "this is a NIfTI image in two files (.hdr and .img)",
                       "Convert it to a single .nii or .nii.gz");
  }
  double bytes = static_cast<double>(header.GetVoxOffset());
  double voxel = header.GetBitPix() / 8.0;
  for (const std::size_t n : sizes) voxel *= static_cast<double>(n);
  bytes += voxel;
  if (!holds_bytes(path, bytes)) {
    return input_error(source, fmt::format("the file ends before its {:.0f} bytes of voxels", voxel),
                       "The file is truncated or damaged; copy or export it again");
  }

  reader->Update();
  vtkImageData& image = *reader->GetOutput();
  if (messages->failed() || reader->GetErrorCode() != 0 || image.GetScalarPointer() == nullptr) return damaged();

  Voxels voxels;
  voxels.source = source;
  Result<VoxelType> type = voxel_type(image, source);
  if (!type) return type.error();
  voxels.type = *type;
  std::size_t volumes = 1;
  for (std::size_t d = 3; d < sizes.size(); ++d) volumes *= std::max<std::size_t>(sizes[d], 1);
  const auto components = static_cast<std::size_t>(image.GetNumberOfScalarComponents());
  if (components != volumes) {
    return input_error(source, fmt::format("a voxel has {} components, 1 is expected", components / volumes),
                       "Export a label mask, not a colour or vector image");
  }
  const std::vector<char> chosen = volumes == 1 ? std::vector<char>() : component_of(image, *volume);
  voxels.data = volumes == 1 ? image.GetScalarPointer() : chosen.data();
  const bool by_sform = header.GetSFormCode() > 0;
  voxels.origin_field = by_sform ? "sform" : "qform";
  voxels.spacing_field = by_sform ? "sform" : "pixdim";
  if (reader->GetRescaleSlope() != 0.0 && std::isfinite(reader->GetRescaleSlope())) {  // 0 means "do not scale"
    voxels.slope = reader->GetRescaleSlope();
    voxels.intercept = reader->GetRescaleIntercept();
  }
  const Vec3 lps(-unit, -unit, unit);
  for (int a = 0; a < 3; ++a) {
    voxels.size[a] = static_cast<std::size_t>(image.GetDimensions()[a]);
    const double spacing = std::abs(image.GetSpacing()[a]);
    for (int row = 0; row < 3; ++row) voxels.axes(row, a) = lps[row] * form->GetElement(row, a) * spacing;
    voxels.origin[a] = lps[a] * form->GetElement(a, 3);
  }
  return to_label_image(voxels);
}

}  // namespace stylet::detail

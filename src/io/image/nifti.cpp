// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of NIfTI-1 and NIfTI-2: VTK reads the header, zlib the voxels. World coordinates of the file are RAS and are
// converted to LPS.
#include "detail/parsers.hpp"
#include "detail/vtk_messages.hpp"
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <zlib.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace stylet::detail {

namespace {

/// The type of a voxel by the header's code (nifti1.h, DT_…).
Result<VoxelType> nifti_voxel_type(int code, const std::string& source) {
  switch (code) {
    case 2:
      return VoxelType::uint8;
    case 4:
      return VoxelType::int16;
    case 8:
      return VoxelType::int32;
    case 16:
      return VoxelType::float32;
    case 64:
      return VoxelType::float64;
    case 256:
      return VoxelType::int8;
    case 512:
      return VoxelType::uint16;
    case 768:
      return VoxelType::uint32;
    case 1024:
      return VoxelType::int64;
    case 1280:
      return VoxelType::uint64;
    case 32:    // complex
    case 1792:  // complex
    case 128:   // RGB
    case 2304:  // RGBA
      return input_error(source,
                         fmt::format("a voxel has {} components, 1 is expected", code == 128    ? 3
                                                                                 : code == 2304 ? 4
                                                                                                : 2),
                         "Export a label mask, not a colour or vector image");
    default:
      return input_error(source, fmt::format("the voxel type (code {}) is not supported", code),
                         "Export the mask as 8- or 16-bit whole numbers");
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

/// A frame as the header states it, in RAS and in the unit of the file.
struct Form {
  Mat3 axes = Mat3::Identity();  ///< columns: steps from one voxel to the next along i, j, k
  Vec3 origin = Vec3::Zero();    ///< centre of the first voxel
};

/// Method 3 of nifti1.h: a matrix.
Form sform_of(vtkNIFTIImageHeader& header) {
  const std::array<const double*, 3> rows{header.GetSRowX(), header.GetSRowY(), header.GetSRowZ()};
  Form form;
  for (int row = 0; row < 3; ++row) {
    for (int a = 0; a < 3; ++a) form.axes(row, a) = rows[static_cast<std::size_t>(row)][a];
    form.origin[row] = rows[static_cast<std::size_t>(row)][3];
  }
  return form;
}

Vec3 pixdim_of(vtkNIFTIImageHeader& header) { return {header.GetPixDim(1), header.GetPixDim(2), header.GetPixDim(3)}; }

/// Method 2 of nifti1.h: a rotation as a quaternion, the voxel spacing (pixdim 1 to 3), and a sign of the third axis
/// (pixdim 0). Errors: a spacing that is not above 0, a quaternion of no rotation.
Result<Form> qform_of(vtkNIFTIImageHeader& header, const std::string& source) {
  const Vec3 pixdim = pixdim_of(header), q(header.GetQuaternB(), header.GetQuaternC(), header.GetQuaternD());
  for (int a = 0; a < 3; ++a) {
    if (pixdim[a] > 0 && std::isfinite(pixdim[a])) continue;
    return input_error(fmt::format("{}, pixdim[{}]", source, a + 1),
                       fmt::format("the value is {:g}, a voxel spacing above 0 is expected", pixdim[a]),
                       "Save the image again, e.g. from 3D Slicer");
  }
  constexpr double kRounding = 1e-3;
  if (!(q.squaredNorm() <= 1 + kRounding)) {
    return input_error(source + ", qform",
                       fmt::format("the quaternion ({:g}, {:g}, {:g}) is no rotation", q.x(), q.y(), q.z()),
                       "Save the image again, e.g. from 3D Slicer");
  }
  const double a = std::sqrt(std::max(0.0, 1 - q.squaredNorm()));
  Form form;
  form.axes = Eigen::Quaterniond(a, q.x(), q.y(), q.z()).normalized().toRotationMatrix() * pixdim.asDiagonal();
  if (header.GetPixDim(0) < 0) form.axes.col(2) *= -1;
  form.origin = {header.GetQOffsetX(), header.GetQOffsetY(), header.GetQOffsetZ()};
  return form;
}

/// Sets the frame of `voxels`. The sform has priority, unless it is no regular grid and the qform is valid.
Result<> place_image(vtkNIFTIImageHeader& header, Voxels& voxels) {
  const bool has_sform = header.GetSFormCode() > 0, has_qform = header.GetQFormCode() > 0;
  if (!has_sform && !has_qform) {
    return input_error(
        voxels.source, "the file does not state the position of the image in the patient (neither sform nor qform)",
        "Save the image again with its orientation, e.g. from 3D Slicer; without it left and right are unknown");
  }
  const double unit = unit_mm(header.GetXYZTUnits());
  if (unit == 0.0) {
    return input_error(voxels.source,
                       fmt::format("the unit of length (code {}) is unknown", header.GetXYZTUnits() & 0x07),
                       "Set xyzt_units to 2 (mm)");
  }
  Form form = sform_of(header);
  const std::optional<std::string> fault = has_sform ? fault_of_axes(form.axes) : std::nullopt;
  bool by_sform = has_sform;
  if (has_qform && (!has_sform || fault)) {
    const Result<Form> qform = qform_of(header, voxels.source);
    if (!qform && !has_sform) return qform.error();
    if (qform) {
      if (has_sform)
        voxels.notes.push_back(fmt::format("The sform cannot be used: {}. The qform counts instead.", *fault));
      form = *qform;
      by_sform = false;
    }
  }
  const Vec3 pixdim = pixdim_of(header), step = form.axes.colwise().norm().transpose();
  constexpr double kSameSpacing = 0.01;
  if (by_sform && !fault && !((pixdim - step).cwiseAbs().array() <= kSameSpacing * step.array()).all()) {
    voxels.notes.push_back(fmt::format(
        "The header states a voxel spacing of {:g} × {:g} × {:g} (pixdim), and its sform one of {:g} × {:g} × "
        "{:g}: the sform counts.",
        pixdim.x(), pixdim.y(), pixdim.z(), step.x(), step.y(), step.z()));
  }
  const Vec3 lps(-unit, -unit, unit);
  voxels.axes = lps.asDiagonal() * form.axes;
  voxels.origin = lps.cwiseProduct(form.origin);
  voxels.origin_field = by_sform ? "sform" : "qform";
  voxels.spacing_field = by_sform ? "sform" : "pixdim";
  return Ok{};
}

/// Position of the first voxel in the unpacked file. It cannot lie within the header, as some programs write.
std::uint64_t start_of_voxels(vtkNIFTIImageHeader& header, std::vector<std::string>& notes) {
  // The header, and four bytes that say whether extensions follow.
  const vtkTypeInt64 least = std::string_view(header.GetMagic()).starts_with("n+2") ? 544 : 352;
  const vtkTypeInt64 stated = header.GetVoxOffset();
  if (stated < least) {
    notes.push_back(fmt::format(
        "The header says that the voxels begin at byte {} (vox_offset), within the header itself: they are read from "
        "byte {} on.",
        stated, least));
  }
  return static_cast<std::uint64_t>(std::max(stated, least));
}

/// The bytes `from` to `to` of a file, unpacked if it is compressed. Empty if it ends before byte `end`.
std::string part_of_file(const std::filesystem::path& path, std::uint64_t from, std::uint64_t to, std::uint64_t end) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) return {};
  std::string bytes;
  std::vector<char> buffer(1 << 16);
  for (std::uint64_t at = 0; at < end;) {
    const int got = gzread(file.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
    if (got <= 0) return {};
    const std::uint64_t next = at + static_cast<std::uint64_t>(got);
    const std::uint64_t first = std::clamp(from, at, next), last = std::clamp(to, at, next);
    bytes.append(buffer.data() + (first - at), last - first);
    at = next;
  }
  return bytes;
}

/// Error if the header's code of the voxel type is in no standard: VTK looks for such a code beyond the end of its
/// table.
Result<> check_voxel_type(const std::filesystem::path& path) {
  constexpr std::size_t kHeader = 348;
  const std::string head = part_of_file(path, 0, kHeader, kHeader);
  if (head.size() < kHeader) return Ok{};  // VTK refuses it
  const auto number = [&]<class T>(T value, std::size_t at) {
    std::memcpy(&value, head.data() + at, sizeof value);
    return value;
  };
  const std::string_view magic = std::string_view(head).substr(4, 3);
  const bool second = magic == "n+2" || magic == "ni2";
  auto code = number(std::uint16_t{}, second ? 12 : 70);
  if (number(std::uint32_t{}, 0) != (second ? 540 : 348)) code = static_cast<std::uint16_t>(code << 8U | code >> 8U);
  constexpr std::array kOfComponents{32, 128, 1792, 2304};
  if (std::find(kOfComponents.begin(), kOfComponents.end(), code) != kOfComponents.end()) return Ok{};
  const Result<VoxelType> type = nifti_voxel_type(code, path.string());
  if (!type) return type.error();
  return Ok{};
}

}  // namespace

Result<LabelImage> parse_nifti(const std::filesystem::path& path, const MaskReadOptions& options) {
  const std::string source = path.string();
  if (Result<> type = check_voxel_type(path); !type) return type.error();
  const auto messages = VtkMessages::install();
  vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  if (messages->failed()) {
    return input_error(source, "the header of the NIfTI file cannot be read",
                       "The file is truncated or damaged; copy or export it again");
  }
  vtkNIFTIImageHeader& header = *reader->GetNIFTIHeader();

  std::vector<std::size_t> sizes;
  const int dimensions = static_cast<int>(std::clamp<vtkTypeInt64>(header.GetDim(0), 0, 7));
  for (int d = 1; d <= dimensions; ++d)
    sizes.push_back(static_cast<std::size_t>(std::max<vtkTypeInt64>(header.GetDim(d), 0)));
  const Result<std::size_t> volume = choose_volume(sizes, options.volume, source);
  if (!volume) return volume.error();
  Voxels voxels;
  voxels.source = source;
  std::copy_n(sizes.begin(), 3, voxels.size.begin());
  if (Result<> placed = place_image(header, voxels); !placed) return placed.error();
  if (!std::string_view(header.GetMagic()).starts_with("n+")) {
    return input_error(source, "this is a NIfTI image in two files (.hdr and .img)",
                       "Convert it to a single .nii or .nii.gz");
  }
  const Result<VoxelType> type = nifti_voxel_type(header.GetDataType(), source);
  if (!type) return type.error();
  voxels.type = *type;

  const std::size_t voxel_bytes = bytes_in(*type);
  double all = static_cast<double>(voxel_bytes);
  for (std::size_t d = 0; d < sizes.size(); ++d) all *= static_cast<double>(std::max<std::size_t>(sizes[d], 1));
  const std::uint64_t start = start_of_voxels(header, voxels.notes);
  constexpr double kMostBytes = 1e15;
  std::string bytes;
  if (all < kMostBytes) {
    const std::uint64_t one = voxel_bytes * voxels.size[0] * voxels.size[1] * voxels.size[2];
    const std::uint64_t first = start + *volume * one;
    bytes = part_of_file(path, first, first + one, start + static_cast<std::uint64_t>(all));
  }
  if (bytes.empty()) {
    return input_error(source, fmt::format("the file ends before its {:.0f} bytes of voxels", all),
                       "The file is truncated or damaged; copy or export it again");
  }
  if (reader->GetSwapBytes() != 0) {
    for (auto value = bytes.begin(); value != bytes.end(); value += static_cast<std::ptrdiff_t>(voxel_bytes))
      std::reverse(value, value + static_cast<std::ptrdiff_t>(voxel_bytes));
  }
  voxels.data = bytes.data();
  if (header.GetSclSlope() != 0.0 && std::isfinite(header.GetSclSlope())) {  // 0 means "do not scale"
    voxels.slope = header.GetSclSlope();
    voxels.intercept = header.GetSclInter();
  }
  return to_label_image(voxels);
}

}  // namespace stylet::detail

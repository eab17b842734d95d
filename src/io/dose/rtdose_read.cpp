// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of dose grids in DICOM RTDOSE (DICOM PS3.3 A.18.3, C.8.8.3).
#include "detail/dicom.hpp"
#include "detail/reach.hpp"
#include "dose/dose_parsers.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

constexpr const char* kExportDoseAgain = "The file is damaged; export the dose again";
constexpr double kMostDosePoints = 2e8;

/// How the numbers of the dose grid are stored, from the header of the file.
struct StoredNumbers {
  int rows = 0, columns = 0, frames = 0, bits_allocated = 0, bits_stored = 0;
  bool has_sign = false;
  double scaling_Gy = 0.0;  // dose of one step
};

/// Positive number of an attribute, or an error that names it.
Result<int> count_of(DcmItem& data, const DcmTagKey& tag, const char* name, const std::string& file) {
  const auto value = integer_of(data, tag);
  if (value && *value > 0) return *value;
  return input_error(file,
                     fmt::format("{} {} is '{}', a whole number above 0 is expected", name,
                                 DcmTag(tag).getXTag().toString().c_str(), text_of(data, tag)),
                     kExportDoseAgain);
}

Result<StoredNumbers> read_numbers(DcmItem& data, const std::string& file) {
  StoredNumbers n;
  const Result<int> rows = count_of(data, DCM_Rows, "Rows", file);
  if (!rows) return rows.error();
  const Result<int> columns = count_of(data, DCM_Columns, "Columns", file);
  if (!columns) return columns.error();
  const Result<int> bits = count_of(data, DCM_BitsAllocated, "BitsAllocated", file);
  if (!bits) return bits.error();
  n.rows = *rows;
  n.columns = *columns;
  n.bits_allocated = *bits;
  n.frames = integer_of(data, DCM_NumberOfFrames).value_or(1);
  n.bits_stored = integer_of(data, DCM_BitsStored).value_or(*bits);
  n.has_sign = integer_of(data, DCM_PixelRepresentation).value_or(0) == 1;
  if (n.bits_allocated != 16 && n.bits_allocated != 32)
    return input_error(file, fmt::format("the doses have {} bits; 16 or 32 are expected", n.bits_allocated),
                       kExportDoseAgain);
  if (n.frames < 1 || static_cast<double>(n.rows) * n.columns * n.frames > kMostDosePoints)
    return input_error(file, fmt::format("the dose grid has {} × {} × {} points", n.columns, n.rows, n.frames),
                       "Export the dose on a coarser grid");
  const std::string units = text_of(data, DCM_DoseUnits);
  if (units != "GY" && units != "CGY") {
    return input_error(file, fmt::format("the doses are given in '{}' (DoseUnits, 3004,0002); GY is expected", units),
                       "Export the dose in Gy, not relative to a normalisation");
  }
  const auto scaling = numbers_of(data, DCM_DoseGridScaling);
  if (scaling.size() != 1 || scaling.front() <= 0.0) {
    return input_error(file,
                       fmt::format("DoseGridScaling (3004,000E) is '{}'; a number above 0 is expected",
                                   text_of(data, DCM_DoseGridScaling)),
                       kExportDoseAgain);
  }
  n.scaling_Gy = scaling.front() * (units == "CGY" ? 0.01 : 1.0);
  return n;
}

/// Offsets of the frames along their normal [mm], from the position of the first one in the file.
Result<std::vector<double>> read_offsets(DcmItem& data, int frames, const Vec3& position, const Vec3& normal,
                                         const std::string& file) {
  std::vector<double> offsets = numbers_of(data, DCM_GridFrameOffsetVector);
  if (frames == 1) return std::vector<double>{0.0};
  if (offsets.size() != static_cast<std::size_t>(frames)) {
    return input_error(file,
                       fmt::format("the grid has {} frames, and GridFrameOffsetVector (3004,000C) has {} numbers",
                                   frames, offsets.size()),
                       kExportDoseAgain);
  }
  // The vector may also hold the frames' own z; PS3.3 C.8.8.3.2.
  const bool absolute = std::abs(offsets.front()) > 1e-6 && std::abs(offsets.front() - position.z()) < 1e-3 &&
                        std::abs(std::abs(normal.z()) - 1.0) < 1e-6;
  const double first = offsets.front();
  if (absolute) {
    for (double& offset : offsets) offset = (offset - first) * (normal.z() > 0.0 ? 1.0 : -1.0);
  }
  return offsets;
}

/// Order of the frames along the normal, from the lowest offset on. Error: the frames are not equally spaced.
Result<std::vector<std::size_t>> order_of(const std::vector<double>& offsets, const std::string& file) {
  std::vector<std::size_t> order(offsets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return offsets[a] < offsets[b]; });
  if (offsets.size() < 2) return order;
  const double step = (offsets[order.back()] - offsets[order.front()]) / static_cast<double>(offsets.size() - 1);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const double here = offsets[order[k]] - offsets[order[k - 1]];
    if (std::abs(here - step) < 0.01 + 1e-3 * step && here > 1e-6) continue;
    return input_error(fmt::format("{}, frames {} and {}", file, order[k - 1] + 1, order[k] + 1),
                       fmt::format("they are {:g} mm apart, the mean distance of the frames is {:g} mm", here, step),
                       "Export the dose on a grid with equal distances");
  }
  return order;
}

/// The words of the pixels, 16 bits each, as DCMTK returns them in the machine's byte order.
struct Words {
  const Uint16* first = nullptr;
  bool high_first = false;  ///< of 32 bits, the upper half comes first
};

/// The number at position `p` of the grid as stored, without the scaling.
double stored_number(const StoredNumbers& n, const Words& words, std::size_t p) {
  if (n.bits_allocated == 16) {
    const Uint16 bits = words.first[p];
    return n.has_sign ? static_cast<double>(static_cast<Sint16>(bits)) : static_cast<double>(bits);
  }
  const std::size_t high = words.high_first ? 0 : 1;
  const Uint32 bits =
      static_cast<Uint32>(words.first[2 * p + high]) << 16U | static_cast<Uint32>(words.first[2 * p + 1 - high]);
  return n.has_sign ? static_cast<double>(static_cast<Sint32>(bits)) : static_cast<double>(bits);
}

/// Sum of the steps between neighbours in a row, which is small for a dose and huge for one whose halves are exchanged.
double roughness(const StoredNumbers& n, const Words& words, std::size_t count) {
  double sum = 0.0;
  for (std::size_t p = 1; p < count; ++p) {
    if (p % static_cast<std::size_t>(n.columns) == 0) continue;
    sum += std::abs(stored_number(n, words, p) - stored_number(n, words, p - 1));
  }
  return sum;
}

/// Sets which half of a number of 32 bits comes first. DCMTK swaps the bytes of each word of 16 bits, but never the
/// words. In little endian the lower half comes first. In explicit big endian the whole number is turned round, so the
/// upper half comes first; programs that convert files word by word leave the lower half first. Such a file is known by
/// its doses: exchanged halves make neighbours differ by many times as much.
void find_word_order(DcmDataset& data, const StoredNumbers& n, std::size_t count, Words& words, DoseGrid& grid) {
  constexpr double kFarRougher = 10.0;
  if (n.bits_allocated != 32 || DcmXfer(data.getOriginalXfer()).getByteOrder() != EBO_BigEndian) return;
  const double low_first = roughness(n, words, count);
  words.high_first = true;
  if (roughness(n, words, count) <= kFarRougher * low_first) return;
  words.high_first = false;
  grid.notes.push_back(
      fmt::format("{} is stored in big endian, but the halves of its 32-bit doses are in the order of little endian, "
                  "as their smooth course shows; they are read so.",
                  grid.file));
}

Result<> read_doses(DcmDataset& data, const StoredNumbers& n, const std::vector<std::size_t>& order, DoseGrid& grid) {
  const auto layer = static_cast<std::size_t>(n.rows) * static_cast<std::size_t>(n.columns);
  const std::size_t count = layer * static_cast<std::size_t>(n.frames);
  grid.dose_Gy.resize(count);
  Words words;
  unsigned long length = 0;
  if (data.findAndGetUint16Array(DCM_PixelData, words.first, &length).bad() || words.first == nullptr) {
    return input_error(grid.file, "the file has no doses that can be read (PixelData is missing or compressed)",
                       "Export the dose without compression");
  }
  const std::size_t words_each = n.bits_allocated == 32 ? 2 : 1;
  if (length < count * words_each) {
    return input_error(grid.file, fmt::format("the file announces {} doses and holds {}", count, length / words_each),
                       kExportDoseAgain);
  }
  find_word_order(data, n, count, words, grid);
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (std::size_t p = 0; p < layer; ++p)
      grid.dose_Gy[k * layer + p] = static_cast<float>(n.scaling_Gy * stored_number(n, words, order[k] * layer + p));
  }
  return Ok{};
}

void note_oddities(const StoredNumbers& n, const std::vector<std::size_t>& order, DoseGrid& grid) {
  const double most = n.scaling_Gy * (std::exp2(n.bits_stored - (n.has_sign ? 1 : 0)) - 1.0);
  const auto full = std::count_if(grid.dose_Gy.begin(), grid.dose_Gy.end(),
                                  [&](float dose) { return static_cast<double>(dose) > most * (1.0 - 1e-6); });
  if (full > 0) {
    grid.largest_Gy = most;
    grid.notes.push_back(
        fmt::format("{} doses of {} are the largest that the file can store, {:.4g} Gy; the true ones may "
                    "be higher.",
                    full, grid.file, most));
  }
  const auto layer = static_cast<std::ptrdiff_t>(n.rows) * n.columns;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto begin = grid.dose_Gy.begin() + static_cast<std::ptrdiff_t>(k) * layer;
    const bool empty = std::all_of(begin, begin + layer, [](float dose) { return dose == 0.0F; });
    if (empty) grid.notes.push_back(fmt::format("Frame {} of {} has no dose at all.", order[k] + 1, grid.file));
  }
}

Result<> check_is_dose(DcmDataset& data, const std::string& file) {
  if (text_of(data, DCM_Modality) == "RTDOSE" || text_of(data, DCM_SOPClassUID) == UID_RTDoseStorage) return Ok{};
  return input_error(file,
                     fmt::format("this DICOM file has modality '{}', RTDOSE is expected", text_of(data, DCM_Modality)),
                     "Name the RT Dose of the plan");
}

}  // namespace

Result<DoseGrid> parse_rtdose(const fs::path& path) {
  const std::string file = path.string();
  DcmFileFormat format;
  const auto check_kind = [&](DcmDataset& data) { return check_is_dose(data, file); };
  if (Result<> loaded = load_dicom(format, path, check_kind, "Name a DICOM RT Dose (modality RTDOSE)"); !loaded)
    return loaded.error();
  DcmDataset& data = *format.getDataset();
  const Result<StoredNumbers> numbers = read_numbers(data, file);
  if (!numbers) return numbers.error();
  const auto position = numbers_of(data, DCM_ImagePositionPatient);
  const auto spacing = numbers_of(data, DCM_PixelSpacing);
  auto orientation = numbers_of(data, DCM_ImageOrientationPatient);
  if (position.size() != 3 || spacing.size() != 2 || spacing[0] <= 0.0 || spacing[1] <= 0.0) {
    return input_error(file, "the place of the grid is missing (ImagePositionPatient or PixelSpacing)",
                       kExportDoseAgain);
  }
  DoseGrid grid;
  grid.file = file;
  if (orientation.size() != 6) {
    orientation = {1, 0, 0, 0, 1, 0};
    grid.notes.push_back(fmt::format("{} does not say the orientation of its grid; it is taken as not turned.", file));
  }
  const Vec3 along_row(orientation[0], orientation[1], orientation[2]);
  const Vec3 along_column(orientation[3], orientation[4], orientation[5]);
  if (std::abs(along_row.norm() - 1.0) > 1e-3 || std::abs(along_column.norm() - 1.0) > 1e-3 ||
      std::abs(along_row.dot(along_column)) > 1e-3) {
    return input_error(file, "the directions of the grid (ImageOrientationPatient) are not perpendicular unit vectors",
                       kExportDoseAgain);
  }
  const Vec3 normal = along_row.cross(along_column).normalized();
  const Vec3 origin(position[0], position[1], position[2]);
  if (Result<> reach = check_reach(file, origin, "the grid's first point"); !reach) return reach.error();
  const Result<std::vector<double>> offsets = read_offsets(data, numbers->frames, origin, normal, file);
  if (!offsets) return offsets.error();
  const Result<std::vector<std::size_t>> order = order_of(*offsets, file);
  if (!order) return order.error();

  grid.frame_of_reference = text_of(data, DCM_FrameOfReferenceUID);
  grid.size = {numbers->columns, numbers->rows, numbers->frames};
  grid.direction.col(0) = along_row.normalized();
  grid.direction.col(1) = along_column.normalized();
  grid.direction.col(2) = normal;
  grid.origin_mm = origin + (*offsets)[order->front()] * normal;
  const double step =
      numbers->frames > 1 ? ((*offsets)[order->back()] - (*offsets)[order->front()]) / (numbers->frames - 1) : 1.0;
  grid.spacing_mm = Vec3(spacing[1], spacing[0], step);  // PixelSpacing: distance of rows first
  grid.quantum_Gy = numbers->scaling_Gy;
  if (Result<> read = read_doses(data, *numbers, *order, grid); !read) return read.error();
  note_oddities(*numbers, *order, grid);
  grid.type = text_of(data, DCM_DoseType);
  grid.summation = text_of(data, DCM_DoseSummationType);
  for (DcmItem* plan : items_of(data, DCM_ReferencedRTPlanSequence)) {
    if (grid.plan_uid.empty()) grid.plan_uid = text_of(*plan, DCM_ReferencedSOPInstanceUID);
  }
  return grid;
}

}  // namespace stylet::detail

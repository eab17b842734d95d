// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of DICOM Segmentations (DICOM PS3.3 A.51, C.8.20, C.7.6.16). One frame is one slice of one segment.
#include "detail/dicom.hpp"
#include "detail/parsers.hpp"
#include "detail/reach.hpp"
#include "detail/text.hpp"
#include "image/segments.hpp"
#include "image/voxels.hpp"

#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/oflog/oflog.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace stylet::detail {

namespace {

constexpr double kAlike = 1e-3;         // tolerance of directions, and relative tolerance of spacings
constexpr double kRegular_mm = 0.01;    // distance of a slice from its place in a regular stack, plus kAlike × height
constexpr double kRegularShare = 0.01;  // the same distance as a share of the slice spacing
constexpr double kMostOff = 0.1;        // distance of a slice from a multiple of the stated spacing, as a share of it
constexpr const char* kExportAgain = "The file is damaged; export the segmentation again, e.g. from 3D Slicer";

/// Position and segment of one frame.
struct Frame {
  Vec3 position = Vec3::Zero();              ///< [mm] LPS, centre of the first pixel
  Vec3 along_row = Vec3::Zero();             ///< unit direction in which the column index grows
  Vec3 along_column = Vec3::Zero();          ///< unit direction in which the row index grows
  std::array<double, 2> pixel_mm{0.0, 0.0};  ///< distance between rows, between columns
  double stated_spacing_mm = 0;              ///< distance between slices; 0 if the file does not state it
  double thickness_mm = 0;                   ///< thickness of the slice; 0 if the file does not state it
  int segment = 0;
  int slice = 0;  ///< index in the stack
};

Error damaged(const std::string& where, const std::string& what) { return input_error(where, what, kExportAgain); }

/// The item of a functional group: the frame's own, or else the shared one; null if there is none.
DcmItem* group_of(DcmItem* own, DcmItem* shared, const DcmTagKey& group) {
  for (DcmItem* item : {own, shared}) {
    if (item == nullptr) continue;
    if (const auto items = items_of(*item, group); !items.empty()) return items.front();
  }
  return nullptr;
}

Result<Frame> read_frame(DcmItem* own, DcmItem* shared, bool label_map, const std::string& where) {
  Frame frame;
  DcmItem* position = group_of(own, shared, DCM_PlanePositionSequence);
  DcmItem* orientation = group_of(own, shared, DCM_PlaneOrientationSequence);
  DcmItem* measures = group_of(own, shared, DCM_PixelMeasuresSequence);
  DcmItem* segment = group_of(own, shared, DCM_SegmentIdentificationSequence);
  const auto place = position ? numbers_of(*position, DCM_ImagePositionPatient) : std::vector<double>();
  const auto turn = orientation ? numbers_of(*orientation, DCM_ImageOrientationPatient) : std::vector<double>();
  const auto pixel = measures ? numbers_of(*measures, DCM_PixelSpacing) : std::vector<double>();
  if (place.size() != 3 || turn.size() != 6 || pixel.size() != 2) {
    return damaged(where, fmt::format("its position in the patient is unknown ({} is missing or damaged)",
                                      place.size() != 3  ? "ImagePositionPatient"
                                      : turn.size() != 6 ? "ImageOrientationPatient"
                                                         : "PixelSpacing"));
  }
  frame.position = Vec3(place[0], place[1], place[2]);
  if (Result<> reach = check_reach(where + ", ImagePositionPatient", frame.position, "its first pixel"); !reach) {
    return reach.error();
  }
  frame.along_row = Vec3(turn[0], turn[1], turn[2]);
  frame.along_column = Vec3(turn[3], turn[4], turn[5]);
  if (std::abs(frame.along_row.norm() - 1) > 1e-2 || std::abs(frame.along_column.norm() - 1) > 1e-2) {
    return damaged(where + ", ImageOrientationPatient",
                   fmt::format("the directions have lengths {:.4g} and {:.4g}, 1 is expected", frame.along_row.norm(),
                               frame.along_column.norm()));
  }
  frame.along_row.normalize();
  frame.along_column.normalize();
  frame.pixel_mm = {pixel[0], pixel[1]};
  if (const auto between = numbers_of(*measures, DCM_SpacingBetweenSlices); between.size() == 1) {
    frame.stated_spacing_mm = std::abs(between[0]);
  }
  if (const auto thick = numbers_of(*measures, DCM_SliceThickness); thick.size() == 1) frame.thickness_mm = thick[0];
  if (!(pixel[0] > 0 && pixel[1] > 0)) {
    return damaged(where + ", PixelSpacing",
                   fmt::format("the spacing is {:g} × {:g} mm, numbers above 0 are expected", pixel[0], pixel[1]));
  }
  if (label_map) return frame;
  const auto number = segment ? integer_of(*segment, DCM_ReferencedSegmentNumber) : std::nullopt;
  if (!number) return damaged(where, "its segment is unknown (ReferencedSegmentNumber)");
  frame.segment = *number;
  return frame;
}

Result<std::vector<Frame>> read_frames(DcmDataset& data, int count, bool label_map, const std::string& source) {
  const auto shared = items_of(data, DCM_SharedFunctionalGroupsSequence);
  const auto own = items_of(data, DCM_PerFrameFunctionalGroupsSequence);
  if (static_cast<int>(own.size()) != count) {
    return damaged(source, fmt::format("the file announces {} frames and describes {}", count, own.size()));
  }
  std::vector<Frame> frames;
  for (int f = 0; f < count; ++f) {
    Result<Frame> frame = read_frame(own[f], shared.empty() ? nullptr : shared.front(), label_map,
                                     fmt::format("{}, frame {}", source, f + 1));
    if (!frame) return frame.error();
    frames.push_back(*frame);
  }
  return frames;
}

/// The distance between slices [mm]. Where the file states it and every distance between neighbouring frames is a
/// multiple of it, it is the stated one (adjusted to the frames), or else the median distance, since most neighbours
/// have no empty slice between them. 0 = all frames lie in one slice.
/// @param heights [mm] sorted @param stated [mm] SpacingBetweenSlices; 0 if not stated
double slice_spacing(const std::vector<double>& heights, double stated) {
  std::vector<double> gaps;
  for (std::size_t s = 1; s < heights.size(); ++s) {
    if (const double gap = heights[s] - heights[s - 1]; gap > kRegular_mm) gaps.push_back(gap);
  }
  if (gaps.empty()) return 0;
  double steps = 0;  // slices from the lowest frame to the highest, if the stated distance is right
  const bool fits = stated > kRegular_mm && std::all_of(gaps.begin(), gaps.end(), [&](double gap) {
                      const double multiple = std::round(gap / stated);
                      steps += multiple;
                      return multiple >= 1 && std::abs(gap - multiple * stated) <=
                                                  kRegular_mm + std::min(kRegularShare * gap, kMostOff * stated);
                    });
  if (fits) return std::accumulate(gaps.begin(), gaps.end(), 0.0) / steps;
  std::sort(gaps.begin(), gaps.end());
  return gaps[(gaps.size() - 1) / 2];
}

/// Notes which slices between the first and the last frame have no frame, and which distance of slices was not taken.
/// @param stated [mm] SpacingBetweenSlices @param thickness [mm] SliceThickness; both 0 if not stated
void note_slices(const std::vector<Frame>& frames, double stated, double thickness, Voxels& voxels) {
  const double spacing = voxels.axes.col(2).norm();
  const double said = stated > 0 ? stated : thickness;
  if (said > 0 && std::abs(said - spacing) > kRegularShare * std::max(said, spacing)) {
    voxels.notes.push_back(fmt::format(
        "{} is {:g} mm, but the frames {}: slices of {:.4g} mm are taken.",
        stated > 0 ? "SpacingBetweenSlices" : "SpacingBetweenSlices is not stated, SliceThickness", said,
        stated > 0 ? "do not lie at multiples of it" : fmt::format("mostly lie {:.4g} mm apart", spacing), spacing));
  }
  std::vector<bool> shown(voxels.size[2], false);
  for (const Frame& frame : frames) shown[static_cast<std::size_t>(frame.slice)] = true;
  std::vector<std::string> places;
  std::size_t missing = 0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (shown[k]) continue;
    std::size_t last = k;
    while (!shown[last + 1]) ++last;  // the last slice has a frame
    missing += last - k + 1;
    places.push_back(k == last ? fmt::format("{}", k + 1) : fmt::format("{} to {}", k + 1, last + 1));
    k = last;
  }
  if (missing == 0) return;
  constexpr std::size_t kMostPlaces = 20;
  const bool more = places.size() > kMostPlaces;
  if (more) places.resize(kMostPlaces);
  voxels.notes.push_back(fmt::format(
      "{} of {} slices of {:.4g} mm have no frame and are empty: slice{} {}{}, counted from the one at ({:.4g}, "
      "{:.4g}, {:.4g}) mm.",
      missing, shown.size(), spacing, missing == 1 ? "" : "s", fmt::join(places, ", "), more ? ", …" : "",
      voxels.origin.x(), voxels.origin.y(), voxels.origin.z()));
}

/// Fits a regular stack to the frames and sets the slice index of each frame.
Result<Voxels> stack_of(std::vector<Frame>& frames, std::size_t rows, std::size_t columns, const std::string& source) {
  const Frame first = frames.front();
  const Vec3 normal = first.along_row.cross(first.along_column).normalized();
  const auto height = [&](const Frame& f) { return normal.dot(f.position - first.position); };
  std::vector<double> heights;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Frame& frame = frames[f];
    const std::string where = fmt::format("{}, frame {}", source, f + 1);
    if ((frame.along_row - first.along_row).norm() > kAlike ||
        (frame.along_column - first.along_column).norm() > kAlike ||
        std::abs(frame.pixel_mm[0] - first.pixel_mm[0]) > kAlike * first.pixel_mm[0] ||
        std::abs(frame.pixel_mm[1] - first.pixel_mm[1]) > kAlike * first.pixel_mm[1]) {
      return input_error(where, "its orientation or pixel spacing differs from the first frame's",
                         "Resample the segmentation to one regular grid, e.g. with 3D Slicer");
    }
    const Vec3 shift = frame.position - first.position - height(frame) * normal;
    if (shift.norm() > kRegular_mm + kAlike * std::abs(height(frame))) {
      return input_error(
          where + ", ImagePositionPatient",
          fmt::format("the slice is shifted sideways by {:.3g} mm against the first one (a sheared stack)",
                      shift.norm()),
          "Resample the segmentation to one regular grid, e.g. with 3D Slicer");
    }
    heights.push_back(height(frame));
  }
  std::vector<double> sorted = heights;
  std::sort(sorted.begin(), sorted.end());
  const double gap = slice_spacing(sorted, first.stated_spacing_mm);
  if (gap == 0) {
    return input_error(source, "all frames lie in one slice, at least 2 slices are needed",
                       "Export the whole volume, not one slice");
  }
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const double steps = (heights[f] - sorted.front()) / gap;
    if (steps > 1e5 || std::abs(steps - std::round(steps)) * gap > kRegular_mm + kRegularShare * gap) {
      return input_error(
          fmt::format("{}, frame {}, ImagePositionPatient", source, f + 1),
          fmt::format(
              "the slice lies {:.4g} mm above the lowest, which is not a multiple of the slice spacing of {:.4g} mm",
              heights[f] - sorted.front(), gap),
          "Resample the segmentation to one regular grid, e.g. with 3D Slicer");
    }
    frames[f].slice = static_cast<int>(std::round(steps));
  }
  const double most_steps = std::round((sorted.back() - sorted.front()) / gap);
  Voxels voxels;
  voxels.source = source;
  voxels.size = {columns, rows, static_cast<std::size_t>(most_steps) + 1};
  voxels.axes.col(0) = first.along_row * first.pixel_mm[1];
  voxels.axes.col(1) = first.along_column * first.pixel_mm[0];
  voxels.axes.col(2) = normal * ((sorted.back() - sorted.front()) / most_steps);
  voxels.origin = first.position + sorted.front() * normal;
  voxels.origin_field = "ImagePositionPatient";
  voxels.spacing_field = "PixelSpacing";
  note_slices(frames, first.stated_spacing_mm, first.thickness_mm, voxels);
  return voxels;
}

/// The meaning of a coded value, e.g. "Peripheral zone of prostate".
std::string meaning_of(DcmItem& item, const DcmTagKey& tag) {
  const auto codes = items_of(item, tag);
  return codes.empty() ? "" : text_of(*codes.front(), DCM_CodeMeaning);
}

/// The meaning of a segment's codes: of its type or, if that is as general as "organ", of its anatomic region.
std::string meaning_of_segment(DcmItem& item) {
  const std::string type = meaning_of(item, DCM_SegmentedPropertyTypeCodeSequence);
  const std::string general = lower(type);
  const bool says_little = general.empty() || general == "organ" || general == "tissue" ||
                           general == "anatomical structure" || general == "body structure";
  const std::string place = says_little ? meaning_of(item, DCM_AnatomicRegionSequence) : "";
  return place.empty() ? type : place;
}

/// Reads the segments in the order of their numbers.
Result<std::vector<Segment>> read_segments(DcmDataset& data, const std::string& source) {
  std::map<int, Segment> segments;
  for (DcmItem* item : items_of(data, DCM_SegmentSequence)) {
    const auto number = integer_of(*item, DCM_SegmentNumber);
    if (!number || *number < 0 || *number > 65535) return damaged(source, "a segment has no number from 1 to 65535");
    if (*number == 0) continue;  // number 0 is the background of a label map
    Segment segment{*number, text_of(*item, DCM_SegmentLabel), meaning_of_segment(*item)};
    if (segment.name.empty()) segment.name = segment.meaning;
    if (!segments.emplace(*number, std::move(segment)).second) {
      return damaged(source, fmt::format("two segments have the number {}", *number));
    }
  }
  if (segments.empty()) return damaged(source, "the file has no segments (SegmentSequence)");
  std::vector<Segment> list;
  for (auto& [number, segment] : segments) list.push_back(std::move(segment));
  return list;
}

/// The pixels of all frames, with one bit, one byte or two bytes each.
struct Pixels {
  const Uint8* bytes = nullptr;
  std::size_t count = 0;  ///< number of bytes
  int bits = 8;
  [[nodiscard]] int operator()(std::size_t n) const {
    if (bits == 1) return bytes[n / 8] >> (n % 8) & 1;  // the first pixel is the lowest bit; no gaps between frames
    return bits == 8 ? bytes[n] : bytes[2 * n] | bytes[2 * n + 1] << 8;
  }
};

Result<Pixels> pixels_of(DcmDataset& data, double wanted, const std::string& source) {
  Pixels pixels;
  pixels.bits = integer_of(data, DCM_BitsAllocated).value_or(0);
  if (pixels.bits != 1 && pixels.bits != 8 && pixels.bits != 16) {
    return damaged(source + ", BitsAllocated", fmt::format("the value is {}, 1, 8 or 16 is expected", pixels.bits));
  }
  if (!data.tagExists(DCM_PixelData)) return damaged(source, "there are no pixels (PixelData)");
  DcmRLEDecoderRegistration::registerCodecs();
  if (data.chooseRepresentation(EXS_LittleEndianExplicit, nullptr).bad()) {
    return input_error(source,
                       fmt::format("its pixels are compressed as {}, which is not supported",
                                   DcmXfer(data.getOriginalXfer()).getXferName()),
                       "Export it uncompressed, or convert it with dcmdjpeg, dcmdjpls or gdcmconv --raw");
  }
  DcmElement* element = nullptr;
  if (data.findAndGetElement(DCM_PixelData, element).bad() || element == nullptr) {
    return damaged(source, "there are no pixels (PixelData)");
  }
  Uint8* bytes = nullptr;
  Uint16* words = nullptr;
  if (element->getUint8Array(bytes).good() && bytes != nullptr) {
    pixels.bytes = bytes;
  } else if (element->getUint16Array(words).good() && words != nullptr) {
    pixels.bytes = reinterpret_cast<const Uint8*>(words);  // little endian, like the file
  }
  pixels.count = pixels.bytes == nullptr ? 0 : element->getLength();
  if (static_cast<double>(pixels.count) * 8 < wanted * pixels.bits) {
    return damaged(source, fmt::format("there are {} bytes of pixels, {:.0f} are expected", pixels.count,
                                       std::ceil(wanted * pixels.bits / 8)));
  }
  return pixels;
}

/// Rule that says which pixels of a frame belong to a segment.
struct Rule {
  bool label_map = false;
  int least = 1;  ///< smallest value of a pixel inside
};

Result<Rule> rule_of(DcmDataset& data, const std::string& source) {
  const std::string type = text_of(data, DCM_SegmentationType);
  if (type == "BINARY") return Rule{};
  if (type == "LABELMAP") return Rule{.label_map = true};
  if (type != "FRACTIONAL") {
    return damaged(source + ", SegmentationType",
                   fmt::format("the value is '{}', BINARY, FRACTIONAL or LABELMAP is expected", type));
  }
  const int most = integer_of(data, DCM_MaximumFractionalValue).value_or(255);
  if (most < 1) {
    return damaged(source + ", MaximumFractionalValue", fmt::format("the value is {}, 1 to 255 is expected", most));
  }
  return Rule{.least = (most + 1) / 2};
}

/// The voxels of all segments.
Result<std::vector<Run>> runs_of(const std::vector<Frame>& frames, const Pixels& pixels, const Rule& rule,
                                 const Voxels& stack, const std::vector<Segment>& segments) {
  std::vector<int> place(std::size_t{1} << 16, -1);  // position in the list, by the segment's number
  for (std::size_t s = 0; s < segments.size(); ++s) place[segments[s].label] = static_cast<int>(s);
  std::vector<Run> runs;
  const std::size_t area = stack.size[0] * stack.size[1];
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t p = 0; p < area; ++p) {
      const int value = pixels(f * area + p);
      const int segment = rule.label_map ? value : value >= rule.least ? frames[f].segment : 0;
      if (segment == 0) continue;
      if (segment < 0 || segment > 65535 || place[segment] < 0) {
        return damaged(fmt::format("{}, frame {}", stack.source, f + 1),
                       fmt::format("it shows segment {}, which the file does not describe", segment));
      }
      add_voxel(runs, static_cast<std::size_t>(frames[f].slice) * area + p, place[segment]);
    }
  }
  return runs;
}

Result<> check_is_segmentation(DcmDataset& data, const std::string& source) {
  const std::string sop_class = text_of(data, DCM_SOPClassUID), modality = text_of(data, DCM_Modality);
  if (sop_class == UID_SurfaceSegmentationStorage) {
    return input_error(source, "this is a DICOM surface segmentation, a segmentation of voxels is expected",
                       "Export the segmentation as DICOM SEG or as a label mask");
  }
  if (modality == "SEG" || sop_class == UID_SegmentationStorage) return Ok{};
  return input_error(source,
                     fmt::format("this DICOM file has modality '{}', a segmentation (SEG) is expected", modality),
                     "Name the segmentation that belongs to it");
}

}  // namespace

Result<LabelImage> parse_dicom_seg(const std::filesystem::path& path, const MaskReadOptions& options) {
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  const std::string source = path.string();
  if (options.volume > 1) {
    return input_error(source, fmt::format("volume {} is chosen, a DICOM segmentation holds one", options.volume),
                       "Leave volume out");
  }
  DcmFileFormat file;
  OFCondition status = file.loadFile(path.c_str());
  if (status.good()) status = file.loadAllDataIntoMemory();
  DcmDataset& data = *file.getDataset();
  if (Result<> right = check_is_segmentation(data, source); !right) return right.error();
  if (status.bad()) {
    return input_error(source, "the DICOM file cannot be read to its end",
                       "The file is truncated or damaged; copy or export it again");
  }
  if (integer_of(data, DCM_InConcatenationTotalNumber).value_or(1) > 1) {
    return input_error(source, "the segmentation is spread over several files (a concatenation)",
                       "Export it as one file");
  }
  const int rows = integer_of(data, DCM_Rows).value_or(0), columns = integer_of(data, DCM_Columns).value_or(0);
  const int count = integer_of(data, DCM_NumberOfFrames).value_or(0);
  if (rows < 2 || columns < 2 || count < 1) {
    return damaged(source, fmt::format("the image has {} columns, {} rows and {} frames", columns, rows, count));
  }
  Result<Rule> rule = rule_of(data, source);
  if (!rule) return rule.error();
  Result<Pixels> pixels = pixels_of(data, static_cast<double>(rows) * columns * count, source);
  if (!pixels) return pixels.error();
  Result<std::vector<Frame>> frames = read_frames(data, count, rule->label_map, source);
  if (!frames) return frames.error();
  Result<Voxels> stack = stack_of(*frames, static_cast<std::size_t>(rows), static_cast<std::size_t>(columns), source);
  if (!stack) return stack.error();
  LabelImage image;
  if (Result<> frame = set_frame(*stack, image); !frame) return frame.error();
  image.notes = stack->notes;
  image.labels.resize(stack->size[0] * stack->size[1] * stack->size[2]);
  const Result<std::vector<Segment>> segments = read_segments(data, source);
  if (!segments) return segments.error();
  const Result<std::vector<Run>> runs = runs_of(*frames, *pixels, *rule, *stack, *segments);
  if (!runs) return runs.error();
  if (rule->least > 1) {
    image.notes.push_back(
        fmt::format("The segments are fractional: a voxel with at least {} of {}, one half, is inside.", rule->least,
                    integer_of(data, DCM_MaximumFractionalValue).value_or(255)));
  }
  if (Result<> painted = paint(*segments, *runs, options.skip, image); !painted) return painted.error();
  if (Result<> extent = check_extent(image); !extent) return extent.error();
  return image;
}

}  // namespace stylet::detail

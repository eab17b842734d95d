// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of DICOM RT Structure Sets (DICOM PS3.3 A.19, C.8.8.5, C.8.8.6, C.8.8.8).
#include "detail/dicom.hpp"
#include "detail/parsers.hpp"
#include "detail/text.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

/// The points of one ContourData value (3006,0050): x\y\z\x\y\z… [mm] LPS; none if the value is empty.
Result<std::vector<Vec3>> parse_points(const char* data, const std::string& where) {
  const auto values = split(data, '\\');
  if (values.size() % 3 != 0) {
    return input_error(where,
                       fmt::format("ContourData has {} numbers, which is not a multiple of three", values.size()), "");
  }
  std::vector<Vec3> points;
  points.reserve(values.size() / 3);
  for (std::size_t i = 0; i < values.size(); i += 3) {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = to_number(values[i + axis]);
      if (!value || !std::isfinite(*value)) {
        return input_error(
            where,
            fmt::format("the coordinate '{}' of point {} is not a finite number", trimmed(values[i + axis]), i / 3 + 1),
            "");
      }
      point[axis] = *value;
    }
    points.push_back(point);
  }
  // Some programs repeat the first point at the end; the copies are dropped.
  while (points.size() > 1 && (points.back() - points.front()).norm() < 1e-3) points.pop_back();
  return points;
}

/// Reads one contour. A damaged one is left out, and a note of the set says so.
std::optional<Contour> read_contour(DcmItem& item, const std::string& name, int number, ContourSet& set) {
  const std::string where = fmt::format("ROI '{}', contour {}", name, number);
  const char* data = nullptr;  // fetched as one text, because fetching number by number takes quadratic time
  if (item.findAndGetString(DCM_ContourData, data).bad() || data == nullptr || trimmed(data).empty()) {
    set.notes.push_back(fmt::format("{}: it has no points and is left out.", where));
    return std::nullopt;
  }
  Result<std::vector<Vec3>> points = parse_points(data, where);
  if (!points) {
    set.notes.push_back(fmt::format("{}: {}. This contour is damaged and is left out.", where, points.error().what));
    return std::nullopt;
  }
  const auto stated = integer_of(item, DCM_NumberOfContourPoints);
  const auto held = static_cast<int>(std::count(data, data + std::strlen(data), '\\') / 3 + 1);
  if (stated && *stated != held) {
    set.notes.push_back(fmt::format("{}: the file announces {} points and holds {}. Those that it holds are used.",
                                    where, *stated, held));
  }
  return Contour{std::move(*points)};
}

struct RoiHeader {
  std::string name;
  std::string frame_of_reference;
};

/// Adds the closed contours of one ROIContourSequence item to `roi`; notes of the set say what was left out.
/// @return geometric types of curves that are not closed, with their number
std::map<std::string, int> read_contours(DcmItem& item, Roi& roi, ContourSet& set) {
  std::map<std::string, int> open;
  int number = 0;
  for (DcmItem* contour_item : items_of(item, DCM_ContourSequence)) {
    ++number;
    const std::string type = text_of(*contour_item, DCM_ContourGeometricType);
    if (type != "CLOSED_PLANAR" && type != "CLOSEDPLANAR_XOR") {
      ++open[type.empty() ? "(no type)" : type];
      continue;
    }
    if (auto contour = read_contour(*contour_item, roi.name, number, set)) roi.contours.push_back(std::move(*contour));
  }
  for (const auto& [type, count] : open) {
    if (roi.contours.empty()) break;
    set.notes.push_back(
        fmt::format("ROI '{}': {} {} curve{} ignored, because only closed planar contours bound a region.", roi.name,
                    count, type, count == 1 ? "" : "s"));
  }
  return open;
}

Result<> check_is_structure_set(DcmDataset& data, const std::string& source) {
  const std::string sop_class = text_of(data, DCM_SOPClassUID);
  const std::string modality = text_of(data, DCM_Modality);
  if (modality == "RTSTRUCT" || sop_class == UID_RTStructureSetStorage) return Ok{};
  if (modality.empty() && sop_class.empty()) {
    return input_error(source, "this is not a DICOM file, or a damaged one (neither modality nor SOP class is stated)",
                       "Name a DICOM RT Structure Set (modality RTSTRUCT)");
  }
  return input_error(source, fmt::format("this DICOM file has modality '{}', RTSTRUCT is expected", modality),
                     "Name the RT Structure Set that belongs to it; images, plans and doses hold no contours");
}

/// The frame of reference of most structures; of the first one where two frames have equally many. Structures in other
/// frames are left out, with a note: nothing here registers images.
void keep_one_frame(const std::map<int, RoiHeader>& headers, std::span<const std::string> skip, ContourSet& set) {
  std::vector<std::pair<std::string, int>> frames;  // in the order of the file
  for (const Roi& roi : set.rois) {
    const std::string& frame = headers.at(roi.number).frame_of_reference;
    if (frame.empty() || is_listed(roi.name, skip)) continue;
    auto found = std::find_if(frames.begin(), frames.end(), [&](const auto& f) { return f.first == frame; });
    if (found == frames.end()) found = frames.insert(frames.end(), {frame, 0});
    ++found->second;
  }
  if (frames.empty()) return;
  set.frame_of_reference = std::max_element(frames.begin(), frames.end(), [](const auto& a, const auto& b) {
                             return a.second < b.second;
                           })->first;
  std::erase_if(set.rois, [&](const Roi& roi) {
    const std::string& frame = headers.at(roi.number).frame_of_reference;
    if (frame.empty() || frame == set.frame_of_reference) return false;
    set.passed_over.push_back({roi.name, "in another frame of reference"});
    set.notes.push_back(
        fmt::format("ROI '{}' is left out: its frame of reference ({}) is not that of the other structures ({}), and "
                    "Stylet does not register images. Export structures of one registration.",
                    roi.name, frame, set.frame_of_reference));
    return true;
  });
}

}  // namespace

Result<ContourSet> parse_rtstruct(const fs::path& path, std::span<const std::string> skip) {
  const std::string source = path.string();
  DcmFileFormat file;
  const auto check_kind = [&](DcmDataset& data) { return check_is_structure_set(data, source); };
  if (Result<> loaded = load_dicom(file, path, check_kind, "Name a DICOM RT Structure Set (modality RTSTRUCT)");
      !loaded)
    return loaded.error();
  DcmDataset& data = *file.getDataset();

  ContourSet set;
  set.source = source;
  set.label = text_of(data, DCM_StructureSetLabel);

  std::map<int, RoiHeader> headers;
  for (DcmItem* item : items_of(data, DCM_StructureSetROISequence)) {
    const auto number = integer_of(*item, DCM_ROINumber);
    RoiHeader header{text_of(*item, DCM_ROIName), text_of(*item, DCM_ReferencedFrameOfReferenceUID)};
    if (!number) {
      set.notes.push_back(
          fmt::format("A structure without a number ('{}') is left out: no contours can refer to it.", header.name));
      continue;
    }
    if (header.name.empty()) header.name = fmt::format("ROI {}", *number);
    if (!headers.emplace(*number, header).second) {
      return input_error(source, fmt::format("two structures have ROI number {}", *number),
                         "Export the structure set again; ROI numbers are unique");
    }
  }
  if (headers.empty()) {
    return input_error(source, "the structure set has no structures", "Export it again with its contours");
  }

  std::map<int, std::string> types;
  for (DcmItem* item : items_of(data, DCM_RTROIObservationsSequence)) {
    if (const auto number = integer_of(*item, DCM_ReferencedROINumber)) {
      types[*number] = text_of(*item, DCM_RTROIInterpretedType);
    }
  }

  std::map<int, std::string> nothing;  // structures without closed contours, and why
  for (const auto& [number, header] : headers) nothing[number] = "empty";
  for (DcmItem* item : items_of(data, DCM_ROIContourSequence)) {
    const auto number = integer_of(*item, DCM_ReferencedROINumber);
    if (!number || !headers.contains(*number)) {
      set.notes.push_back(fmt::format("Contours that refer to {} are left out: the file has no such structure.",
                                      number ? fmt::format("ROI number {}", *number) : "no ROI number"));
      continue;
    }
    const auto known =
        std::find_if(set.rois.begin(), set.rois.end(), [&](const Roi& roi) { return roi.number == *number; });
    Roi roi;
    if (known != set.rois.end()) {
      set.notes.push_back(
          fmt::format("The contours of ROI '{}' are in several items of the file, which are joined.", known->name));
      roi = std::move(*known);
      set.rois.erase(known);
    } else {
      roi.name = headers.at(*number).name;
      roi.number = *number;
      roi.type = types[*number];
      const std::string colour_text = text_of(*item, DCM_ROIDisplayColor);
      const auto colour = split(colour_text, '\\');
      for (std::size_t i = 0; colour.size() == 3 && i < 3; ++i) {
        roi.colour[i] = static_cast<int>(std::clamp(to_number(colour[i]).value_or(255.0), 0.0, 255.0));
      }
    }
    const auto open = read_contours(*item, roi, set);
    if (roi.contours.empty()) {
      if (!open.empty()) nothing[*number] = "only open curves or points";
      continue;
    }
    nothing.erase(*number);
    set.rois.push_back(std::move(roi));
  }
  for (const auto& [number, why] : nothing) set.passed_over.push_back({headers.at(number).name, why});
  keep_one_frame(headers, skip, set);
  if (set.frame_of_reference.empty()) {
    const auto frames = items_of(data, DCM_ReferencedFrameOfReferenceSequence);
    if (!frames.empty()) set.frame_of_reference = text_of(*frames.front(), DCM_FrameOfReferenceUID);
    if (set.frame_of_reference.empty()) set.frame_of_reference = text_of(data, DCM_FrameOfReferenceUID);
  }
  if (set.rois.empty()) {
    return input_error(source, fmt::format("none of its {} structures has a closed planar contour", headers.size()),
                       "Contour the structures before exporting");
  }
  return set;
}

}  // namespace stylet::detail

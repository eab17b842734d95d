// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of DICOM RT Structure Sets (DICOM PS3.3 A.19, C.8.8.5, C.8.8.6, C.8.8.8).
#include "detail/dicom.hpp"
#include "detail/parsers.hpp"
#include "detail/text.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

/// The points of one ContourData value (3006,0050): x\y\z\x\y\z… [mm] LPS.
Result<Contour> parse_points(DcmItem& item, const std::string& where) {
  const char* data = nullptr;  // fetched as one text, because fetching number by number takes quadratic time
  if (item.findAndGetString(DCM_ContourData, data).bad() || data == nullptr || *data == '\0') {
    return input_error(where, "the contour has no points (ContourData is missing or empty)",
                       "Export the structure set again");
  }
  const auto values = split(data, '\\');
  if (values.size() % 3 != 0) {
    return input_error(where,
                       fmt::format("ContourData has {} numbers, which is not a multiple of three", values.size()),
                       "The file is damaged; export the structure set again");
  }
  Contour contour;
  contour.points.reserve(values.size() / 3);
  for (std::size_t i = 0; i < values.size(); i += 3) {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = to_number(values[i + axis]);
      if (!value || !std::isfinite(*value)) {
        return input_error(fmt::format("{}, point {}", where, i / 3 + 1),
                           fmt::format("the coordinate '{}' is not a finite number", trimmed(values[i + axis])),
                           "The file is damaged; export the structure set again");
      }
      point[axis] = *value;
    }
    contour.points.push_back(point);
  }
  const auto stated = integer_of(item, DCM_NumberOfContourPoints);
  if (stated && *stated != static_cast<int>(contour.points.size())) {
    return input_error(where, fmt::format("the file announces {} points and holds {}", *stated, contour.points.size()),
                       "The file is damaged; export the structure set again");
  }
  // Some programs repeat the first point at the end; the copies are dropped.
  while (contour.points.size() > 1 && (contour.points.back() - contour.points.front()).norm() < 1e-3) {
    contour.points.pop_back();
  }
  return contour;
}

struct RoiHeader {
  std::string name;
  std::string frame_of_reference;
};

/// Reads the closed contours of one ROIContourSequence item into `roi`; adds a note to the set on what it ignored.
Result<> read_contours(DcmItem& item, Roi& roi, ContourSet& set) {
  const std::string& source = set.source;
  std::map<std::string, int> passed_over;
  int number = 0;
  for (DcmItem* contour_item : items_of(item, DCM_ContourSequence)) {
    ++number;
    const std::string where = fmt::format("{}, ROI '{}', contour {}", source, roi.name, number);
    const std::string type = text_of(*contour_item, DCM_ContourGeometricType);
    if (type != "CLOSED_PLANAR" && type != "CLOSEDPLANAR_XOR") {
      ++passed_over[type.empty() ? "(no type)" : type];
      continue;
    }
    Result<Contour> contour = parse_points(*contour_item, where);
    if (!contour) return contour.error();
    roi.contours.push_back(std::move(*contour));
  }
  if (roi.contours.empty()) {
    set.passed_over.push_back({roi.name, passed_over.empty() ? "empty" : "only open curves or points"});
    return Ok{};
  }
  for (const auto& [type, count] : passed_over) {
    set.notes.push_back(
        fmt::format("ROI '{}': {} {} curve{} ignored, because only closed planar contours bound a region.", roi.name,
                    count, type, count == 1 ? "" : "s"));
  }
  return Ok{};
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

/// Checks that a structure has the frame of reference of the set, which is that of its first structure.
Result<> in_the_sets_frame(const Roi& roi, const RoiHeader& header, ContourSet& set) {
  if (set.frame_of_reference.empty()) set.frame_of_reference = header.frame_of_reference;
  if (header.frame_of_reference.empty() || header.frame_of_reference == set.frame_of_reference) return Ok{};
  return input_error(fmt::format("{}, ROI '{}'", set.source, roi.name),
                     "its frame of reference differs from that of the structures before it in the file",
                     "Export structures of one registration only; Stylet does not register images");
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
    if (!number) {
      return input_error(source, "a structure has no ROI number",
                         "The file is damaged; export the structure set again");
    }
    RoiHeader header{text_of(*item, DCM_ROIName), text_of(*item, DCM_ReferencedFrameOfReferenceUID)};
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

  std::map<int, bool> has_contour_item;
  for (DcmItem* item : items_of(data, DCM_ROIContourSequence)) {
    const auto number = integer_of(*item, DCM_ReferencedROINumber);
    if (!number || !headers.contains(*number)) {
      return input_error(source, "contours refer to a structure that is not in the file",
                         "The file is damaged; export the structure set again");
    }
    const RoiHeader& header = headers.at(*number);
    has_contour_item[*number] = true;
    Roi roi;
    roi.name = header.name;
    roi.number = *number;
    roi.type = types[*number];
    const std::string colour_text = text_of(*item, DCM_ROIDisplayColor);
    const auto colour = split(colour_text, '\\');
    for (std::size_t i = 0; colour.size() == 3 && i < 3; ++i) {
      roi.colour[i] = static_cast<int>(std::clamp(to_number(colour[i]).value_or(255.0), 0.0, 255.0));
    }
    Result<> usable = read_contours(*item, roi, set);
    if (usable && roi.contours.empty()) continue;
    const bool may_go = is_listed(roi.name, skip);
    if (usable && !(may_go && set.frame_of_reference.empty())) usable = in_the_sets_frame(roi, header, set);
    if (!usable && may_go) {
      set.passed_over.push_back({roi.name, "damaged, and named in [patient] skip"});
      continue;
    }
    if (!usable) {
      Error error = usable.error();
      error.cure += or_skip(roi.name);
      return error;
    }
    set.rois.push_back(std::move(roi));
  }
  for (const auto& [number, header] : headers) {
    if (!has_contour_item.contains(number)) set.passed_over.push_back({header.name, "empty"});
  }
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

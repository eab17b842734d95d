// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of DICOM RT Structure Sets (DICOM PS3.3 A.19). It uses implicit VR little endian, because explicit VR limits
// ContourData (VR DS) to 64 KiB, which a body outline exceeds.
#include "detail/dicom_write.hpp"
#include "detail/text.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/contours_io.hpp"
#include "stylet/io/files.hpp"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fmt/format.h>

#include <cmath>
#include <set>

namespace stylet {

namespace {

namespace fs = std::filesystem;
using detail::decimal_string;
using detail::derived_uid;
using detail::Filler;

constexpr double max_coordinate_mm = 1e6;  // DS holds 16 characters: 1e6 with four decimals is safe
constexpr std::size_t max_name = 64;       // length of VR LO

std::string contour_data(const Contour& contour) {
  std::string text;
  text.reserve(contour.points.size() * 30);
  for (const Vec3& p : contour.points) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!text.empty()) text += '\\';
      text += decimal_string(p[axis]);
    }
  }
  return text;
}

/// Text with all data of a structure set, from which its identifiers are derived.
std::string fingerprint(const ContourSet& set) {
  std::string text = set.label + '\n' + set.frame_of_reference + '\n';
  for (const Roi& roi : set.rois) {
    text += fmt::format("{}\n{}\n{}\n", roi.name, roi.number, roi.type);
    for (const Contour& contour : roi.contours) text += contour_data(contour) + '\n';
  }
  return text;
}

Result<> check(const ContourSet& set, const std::string& where) {
  if (set.rois.empty()) return failure(where, "there are no structures to write", "Draw at least one structure");
  for (const Roi& roi : set.rois) {
    const std::string place = fmt::format("{}, ROI '{}'", where, roi.name);
    if (roi.name.empty() || roi.name.size() > max_name || roi.name.find('\\') != std::string::npos) {
      return failure(place, fmt::format("a DICOM name has 1 to {} bytes and no backslash", max_name),
                     "Rename the structure");
    }
    for (const Contour& contour : roi.contours) {
      for (const Vec3& p : contour.points) {
        if (!p.allFinite() || p.cwiseAbs().maxCoeff() > max_coordinate_mm) {
          return failure(place,
                         fmt::format("the point ({}, {}, {}) mm is not finite or too far away", p.x(), p.y(), p.z()),
                         "Correct the contour before writing it");
        }
      }
    }
  }
  return Ok{};
}

/// The ROI numbers of the set, or 1, 2, … if those are not unique.
std::vector<int> roi_numbers(const ContourSet& set) {
  std::vector<int> numbers;
  for (const Roi& roi : set.rois) numbers.push_back(roi.number);
  const std::set<int> distinct(numbers.begin(), numbers.end());
  if (distinct.size() != numbers.size() || *distinct.begin() < 0) {
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i) + 1;
  }
  return numbers;
}

/// A text as VR CS holds it: at most 16 capitals, digits, blanks and underscores; empty if it has anything else.
std::string code_string(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  const bool allowed = text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 _") == std::string::npos;
  return allowed && text.size() <= 16 ? text : "";
}

void fill_header(Filler& fill, DcmDataset& data, const ContourSet& set, const std::string& print,
                 const std::string& frame, const PatientRecord& patient) {
  detail::fill_common(fill, data, UID_RTStructureSetStorage, "RTSTRUCT", print, patient);
  fill.text(data, DCM_InstanceNumber, "1");
  fill.text(data, DCM_FrameOfReferenceUID, frame);
  fill.text(data, DCM_PositionReferenceIndicator, patient.position_reference);
  fill.text(data, DCM_ApprovalStatus, "UNAPPROVED");
  for (const DcmTagKey& empty : {DCM_StructureSetDate, DCM_StructureSetTime}) fill.text(data, empty, "");
  // SH holds 16 characters.
  fill.text(data, DCM_StructureSetLabel, set.label.empty() ? "Stylet" : detail::short_text(set.label, 16));
}

void fill_structures(Filler& fill, DcmDataset& data, const ContourSet& set, const std::string& frame) {
  fill.text(fill.new_item(data, DCM_ReferencedFrameOfReferenceSequence), DCM_FrameOfReferenceUID, frame);
  const std::vector<int> numbers = roi_numbers(set);
  for (std::size_t i = 0; i < set.rois.size(); ++i) {
    const Roi& roi = set.rois[i];
    const std::string number = std::to_string(numbers[i]);

    DcmItem& header = fill.new_item(data, DCM_StructureSetROISequence);
    fill.text(header, DCM_ROINumber, number);
    fill.text(header, DCM_ReferencedFrameOfReferenceUID, frame);
    fill.text(header, DCM_ROIName, roi.name);
    fill.text(header, DCM_ROIGenerationAlgorithm, "");

    DcmItem& drawing = fill.new_item(data, DCM_ROIContourSequence);
    fill.text(drawing, DCM_ReferencedROINumber, number);
    fill.text(drawing, DCM_ROIDisplayColor, fmt::format("{}\\{}\\{}", roi.colour[0], roi.colour[1], roi.colour[2]));
    for (const Contour& contour : roi.contours) {
      DcmItem& item = fill.new_item(drawing, DCM_ContourSequence);
      fill.text(item, DCM_ContourGeometricType, "CLOSED_PLANAR");
      fill.text(item, DCM_NumberOfContourPoints, std::to_string(contour.points.size()));
      fill.text(item, DCM_ContourData, contour_data(contour));
    }

    DcmItem& observation = fill.new_item(data, DCM_RTROIObservationsSequence);
    fill.text(observation, DCM_ObservationNumber, std::to_string(i + 1));
    fill.text(observation, DCM_ReferencedROINumber, number);
    fill.text(observation, DCM_RTROIInterpretedType, code_string(roi.type));
    fill.text(observation, DCM_ROIInterpreter, "");
  }
}

}  // namespace

Result<> write_rtstruct(const ContourSet& contours, const fs::path& path, const PatientRecord& patient) {
  if (Result<> sound = check(contours, path.string()); !sound) return sound;
  const std::string print = fingerprint(contours) + detail::print_of(patient) + version();
  std::string frame = patient.frame_of_reference;
  if (frame.empty()) frame = contours.frame_of_reference;
  if (frame.empty()) frame = derived_uid(print, "frame");
  DcmFileFormat file;
  Filler fill;
  fill_header(fill, *file.getDataset(), contours, print, frame, patient);
  fill_structures(fill, *file.getDataset(), contours, frame);
  auto bytes = detail::dicom_bytes(file, fill, path.string(), EXS_LittleEndianImplicit, "RT Structure Set");
  if (!bytes) return bytes.error();
  return write_whole_file(path, *bytes);
}

}  // namespace stylet

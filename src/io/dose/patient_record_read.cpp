// SPDX-License-Identifier: GPL-3.0-or-later
// Reads patient, study and frame of reference of a DICOM file.
#include "detail/dicom.hpp"
#include "detail/file_kind.hpp"
#include "detail/parsers.hpp"
#include "detail/patient_attributes.hpp"
#include "dose/dose_parsers.hpp"
#include "reading/ask.hpp"
#include "reading/tasks.hpp"
#include "stylet/core/printable.hpp"
#include "stylet/dose/strength_age.hpp"
#include "stylet/io/patient_record_io.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet {

namespace {

namespace fs = std::filesystem;
using detail::RecordText;

/// Whether a text has characters that stand for bytes outside its character set.
bool is_replaced(const std::string& text) { return text.find("\xEF\xBF\xBD") != std::string::npos; }

std::string from_latin1(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xc0U | (byte >> 6U));
      out += static_cast<char>(0x80U | (byte & 0x3fU));
    }
  }
  return out;
}

/// A time in the notation of DICOM, from "10:15:30" too; empty if the text is none.
std::string time_of(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), ':'), text.end());
  return parse_date_time("20000101 " + text) ? text : "";
}

/// A text as DICOM allows it; empty if it cannot be.
std::string allowed(const std::string& text, RecordText kind) {
  switch (kind) {
    case RecordText::any:
      return text;
    case RecordText::date: {
      const auto date = parse_date_time(text);
      return date && date->seconds < 0 ? date->dicom_date() : "";
    }
    case RecordText::time:
      return time_of(text);
    case RecordText::sex:
      return text == "M" || text == "F" || text == "O" ? text : "";
  }
  return "";
}

}  // namespace

Result<FoundPatient> detail::parse_patient_record(const fs::path& path) {
  DcmFileFormat format;
  const auto any_kind = [](DcmDataset&) -> Result<> { return Ok{}; };
  if (Result<> loaded = detail::load_dicom(format, path, any_kind, "Name a DICOM file of the patient"); !loaded)
    return loaded.error();
  DcmDataset& data = *format.getDataset();
  FoundPatient record;
  record.file = path.string();
  for (const detail::PatientAttribute& attribute : detail::kPatientAttributes) {
    std::string text = detail::text_of(data, attribute.tag);
    const std::string bytes = detail::bytes_of(data, attribute.tag);
    if (is_replaced(text) && !is_replaced(bytes)) {
      text = printable(from_latin1(bytes));
      record.notes.push_back(
          fmt::format("{}: the {} is not in the file's character set ('{}'); it is read as Latin-1, '{}'. Check it.",
                      record.file, attribute.name, detail::text_of(data, DCM_SpecificCharacterSet), text));
    }
    record.*attribute.text = allowed(text, attribute.kind);
    if (!text.empty() && (record.*attribute.text).empty())
      record.notes.push_back(fmt::format("{}: the {} is '{}', which DICOM does not allow; it is left out.", record.file,
                                         attribute.name, text));
  }
  record.study_uid = detail::text_of(data, DCM_StudyInstanceUID);
  record.frame_of_reference = detail::text_of(data, DCM_FrameOfReferenceUID);
  if (record.frame_of_reference.empty()) {
    const auto frames = detail::items_of(data, DCM_ReferencedFrameOfReferenceSequence);
    if (frames.size() == 1) record.frame_of_reference = detail::text_of(*frames.front(), DCM_FrameOfReferenceUID);
  }
  record.position_reference = detail::text_of(data, DCM_PositionReferenceIndicator);
  if (detail::text_of(data, DCM_SOPClassUID) == UID_RTStructureSetStorage) {
    record.structure_set = detail::text_of(data, DCM_SOPInstanceUID);
  } else {
    const auto sets = detail::items_of(data, DCM_ReferencedStructureSetSequence);
    if (!sets.empty()) record.structure_set = detail::text_of(*sets.front(), DCM_ReferencedSOPInstanceUID);
  }
  return record;
}

Result<FoundPatient> read_patient_record(const fs::path& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) {
    const Result<std::string> found = detail::ask(detail::kOnlyPatient, path);
    return found ? read_patient_record(*found) : Result<FoundPatient>(found.error());
  }
  const Result<detail::FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  if (*kind != detail::FileKind::dicom) return FoundPatient{};
  return detail::ask(detail::kPatientRecord, path);
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/dicom.hpp"

#include "detail/dicom_text.hpp"
#include "detail/parsers.hpp"
#include "detail/text.hpp"

#include <dcmtk/oflog/oflog.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

/// SpecificCharacterSet (0008,0005) of an item, or of the nearest one around it that states it.
std::string character_sets(DcmObject& item) {
  for (DcmObject* object = &item; object != nullptr; object = object->getParent()) {
    auto* around = dynamic_cast<DcmItem*>(object);
    OFString value;
    if (around != nullptr && around->findAndGetOFStringArray(DCM_SpecificCharacterSet, value).good())
      return {value.data(), value.size()};
  }
  return {};
}

}  // namespace

std::string bytes_of(DcmItem& item, const DcmTagKey& tag) {
  OFString value;
  if (item.findAndGetOFStringArray(tag, value).bad()) return {};
  return trimmed({value.data(), value.size()});
}

std::string text_of(DcmItem& item, const DcmTagKey& tag) {
  const std::string bytes = bytes_of(item, tag);
  if (std::all_of(bytes.begin(), bytes.end(), [](char c) { return c >= ' ' && c < '\x7F'; })) return bytes;
  return trimmed(dicom_utf8(bytes, character_sets(item)));
}

std::optional<int> integer_of(DcmItem& item, const DcmTagKey& tag) {
  const auto number = to_number(text_of(item, tag));
  if (!number || std::abs(*number) > 2e9 || *number != std::floor(*number)) return std::nullopt;
  return static_cast<int>(*number);
}

std::vector<double> numbers_of(DcmItem& item, const DcmTagKey& tag) {
  const std::string text = text_of(item, tag);
  std::vector<double> numbers;
  for (const auto part : split(text, '\\')) {
    const auto number = to_number(part);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<DcmItem*> items_of(DcmItem& parent, const DcmTagKey& tag) {
  std::vector<DcmItem*> items;
  DcmSequenceOfItems* sequence = nullptr;
  if (parent.findAndGetSequence(tag, sequence).bad() || sequence == nullptr) return items;
  for (unsigned long i = 0; i < sequence->card(); ++i) {
    if (DcmItem* item = sequence->getItem(i)) items.push_back(item);
  }
  return items;
}

namespace {

/// Whether a file has the mark "DICM" after a preamble of 128 bytes (DICOM PS3.10 7.1).
bool has_dicom_mark(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 132> head{};
  return file.read(head.data(), head.size()) && std::string_view(head.data() + 128, 4) == "DICM";
}

}  // namespace

DicomKind kind_of_dicom(const fs::path& path) {
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  DcmFileFormat file;
  if (file.loadFileUntilTag(path.c_str(), EXS_Unknown, EGL_noChange, 4096, ERM_autoDetect, DCM_Manufacturer).bad()) {
    return {};
  }
  return {text_of(*file.getDataset(), DCM_SOPClassUID), text_of(*file.getDataset(), DCM_Modality)};
}

Result<> load_dicom(DcmFileFormat& file, const fs::path& path, const std::function<Result<>(DcmDataset&)>& check_kind,
                    const std::string& name_another) {
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  OFCondition status = file.loadFile(path.c_str());
  if (status.good()) status = file.loadAllDataIntoMemory();
  DcmDataset& data = *file.getDataset();
  const bool has_header = !text_of(data, DCM_SOPClassUID).empty();
  if (status.good() || has_header) {
    if (Result<> kind = check_kind(data); !kind) return kind;
  }
  if (status.bad() && !has_header && !has_dicom_mark(path))
    return input_error(path.string(), "this is not a DICOM file", name_another);
  if (status.bad()) {
    return input_error(path.string(), "the DICOM file cannot be read to its end",
                       "The file is truncated or damaged; copy or export it again");
  }
  return Ok{};
}

bool is_dicom_seg(const fs::path& path) {
  const DicomKind kind = kind_of_dicom(path);
  return kind.modality == "SEG" || kind.sop_class == UID_SegmentationStorage;
}

Result<std::string> only_patient_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const DicomKind kind = kind_of_dicom(entry.path());
    if (kind.modality == "RTSTRUCT" || kind.sop_class == UID_RTStructureSetStorage || kind.modality == "SEG" ||
        kind.sop_class == UID_SegmentationStorage) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  if (found.empty()) {
    return input_error(folder.string(), "the folder holds no DICOM RT Structure Set and no DICOM segmentation (SEG)",
                       "Name the file itself, or the folder in which it lies");
  }
  if (found.size() == 1) return found.front().string();
  std::vector<std::string> names;
  for (const fs::path& path : found) names.push_back(path.filename().string());
  return input_error(folder.string(),
                     fmt::format("the folder holds {} RT Structure Sets and segmentations, one is expected: {}",
                                 found.size(), fmt::join(names, ", ")),
                     "Name one of these files instead of the folder");
}

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/dicom.hpp"

#include "detail/parsers.hpp"
#include "detail/text.hpp"

#include <dcmtk/oflog/oflog.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace stylet::detail {

namespace fs = std::filesystem;

std::string text_of(DcmItem& item, const DcmTagKey& tag) {
  OFString value;
  if (item.findAndGetOFStringArray(tag, value).bad()) return {};
  return trimmed({value.data(), value.size()});
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

/// SOP class and modality of a file, read without its other data, which is fast even for a folder of a thousand slices.
struct DicomKind {
  std::string sop_class, modality;
};

DicomKind kind_of_dicom(const fs::path& path) {
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  DcmFileFormat file;
  if (file.loadFileUntilTag(path.c_str(), EXS_Unknown, EGL_noChange, 4096, ERM_autoDetect, DCM_Manufacturer).bad()) {
    return {};
  }
  return {text_of(*file.getDataset(), DCM_SOPClassUID), text_of(*file.getDataset(), DCM_Modality)};
}

}  // namespace

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/dicom.hpp"

#include "detail/parsers.hpp"
#include "detail/text.hpp"

#include <dcmtk/oflog/oflog.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

/// A Japanese text with escape sequences (ISO 2022 IR 6, 13, 87 and 159; PS3.3 C.12.1.1.2), which DCMTK does not
/// convert everywhere, as UTF-8. Bytes above 127 are half-width katakana (JIS X 0201). Unchanged if it is anything
/// else.
std::string utf8_of_japanese(const std::string& text) {
  const std::unique_ptr<void, int (*)(void*)> converter(iconv_open("UTF-8", "ISO-2022-JP-2"), [](void* open) {
    return open == reinterpret_cast<void*>(-1) ? 0 : iconv_close(open);
  });
  if (converter.get() == reinterpret_cast<void*>(-1)) return text;
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = static_cast<unsigned char>(text[at]);
    if (byte >= 0x80) {
      if (byte < 0xa1 || byte > 0xdf) return text;
      const unsigned code = 0xff61U + (byte - 0xa1U);
      out += {'\xef', static_cast<char>(0x80U | ((code >> 6U) & 0x3fU)), static_cast<char>(0x80U | (code & 0x3fU))};
      ++at;
      continue;
    }
    std::size_t end = at;  // end of the 7-bit part, in which escape sequences may switch between alphabets
    while (end < text.size() && static_cast<unsigned char>(text[end]) < 0x80) ++end;
    std::string in = text.substr(at, end - at), piece(4 * in.size() + 16, '\0');
    char* from = in.data();
    char* to = piece.data();
    std::size_t left = in.size(), room = piece.size();
    if (iconv(converter.get(), &from, &left, &to, &room) == static_cast<std::size_t>(-1)) return text;
    out.append(piece, 0, piece.size() - room);
    at = end;
  }
  return out;
}

}  // namespace

std::string text_of(DcmItem& item, const DcmTagKey& tag) {
  OFString value;
  if (item.findAndGetOFStringArray(tag, value).bad()) return {};
  const std::string text = trimmed({value.data(), value.size()});
  return text.find('\x1b') == std::string::npos ? text : trimmed(utf8_of_japanese(text));
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
    return input_error(path.string(), fmt::format("the DICOM file cannot be read to its end ({})", status.text()),
                       "The file is truncated or damaged; copy or export it again");
  }
  data.convertToUTF8();  // on failure the bytes stay unchanged
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

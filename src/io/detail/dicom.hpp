// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "stylet/core/result.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Access to DICOM attributes, shared by the DICOM readers. To be called in the reading program only.
namespace stylet::detail {

/// SOP class and modality of a DICOM file.
struct DicomKind {
  std::string sop_class, modality;
};

/// Reads the kind of a file without its other data, which is fast even for a folder of a thousand slices. Empty texts:
/// the file is not DICOM.
DicomKind kind_of_dicom(const std::filesystem::path& path);

/// Reads a whole file into memory.
/// @param check_kind is called as soon as the file has a header: an error about the wrong kind of file helps more than
///   one about the place where the file ends
/// @param name_another cure for a file that is not DICOM
/// Errors: not a DICOM file, the error of `check_kind`, a file that ends too early.
Result<> load_dicom(DcmFileFormat& file, const std::filesystem::path& path,
                    const std::function<Result<>(DcmDataset&)>& check_kind, const std::string& name_another);

/// All values of an attribute as one text, trimmed, in UTF-8 by the character set that the file states, and without
/// control characters; empty if it is absent.
std::string text_of(DcmItem& item, const DcmTagKey& tag);

/// The same in the bytes of the file.
std::string bytes_of(DcmItem& item, const DcmTagKey& tag);

/// The value of an attribute as a whole number; empty if it is absent or not a whole number.
std::optional<int> integer_of(DcmItem& item, const DcmTagKey& tag);

/// The numbers of an attribute with several values; empty if it is absent or one of them is not a finite number.
std::vector<double> numbers_of(DcmItem& item, const DcmTagKey& tag);

/// The items of a sequence; none if it is absent.
std::vector<DcmItem*> items_of(DcmItem& parent, const DcmTagKey& tag);

}  // namespace stylet::detail

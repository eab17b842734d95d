// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "stylet/core/result.hpp"
#include "stylet/dose/patient_record.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Numbers, identifiers and attributes for the writers of DICOM files.
namespace stylet::detail {

/// A number as text of VR DS: four decimals without trailing zeros.
std::string decimal_string(double value);

/// A number as text of VR DS with as many digits as its 16 characters hold.
std::string precise_decimal_string(double value);

/// A text as an attribute of one value holds it: at most so many characters, none of them a backslash or control.
std::string short_text(const std::string& text, std::size_t most);

/// A unique identifier derived from the content (UUID version 5 under DICOM's root 2.25, PS3.5 B.2). The same content
/// gives the same identifier, which contains nothing about this computer.
std::string derived_uid(const std::string& content, std::string_view role);

/// Writes attributes into an item and keeps the first failure.
class Filler {
 public:
  Filler();  ///< DCMTK does not write to the terminal from here on
  void text(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
    keep(item.putAndInsertOFStringArray(tag, OFString(value.data(), value.size())));
  }
  void floats(DcmItem& item, const DcmTagKey& tag, const std::vector<Float32>& values) {
    keep(item.putAndInsertFloat32Array(tag, values.data(), static_cast<unsigned long>(values.size())));
  }
  void number(DcmItem& item, const DcmTagKey& tag, Uint16 value) { keep(item.putAndInsertUint16(tag, value)); }
  void words(DcmItem& item, const DcmTagKey& tag, const std::vector<Uint16>& values) {
    keep(item.putAndInsertUint16Array(tag, values.data(), static_cast<unsigned long>(values.size())));
  }
  void tag(DcmItem& item, const DcmTagKey& tag, const DcmTagKey& value) { keep(item.putAndInsertTagKey(tag, value)); }
  DcmItem& new_item(DcmItem& parent, const DcmTagKey& sequence) {
    DcmItem* item = nullptr;
    keep(parent.findOrCreateSequenceItem(sequence, item, -2));  // -2 appends
    return item == nullptr ? spare_ : *item;
  }
  [[nodiscard]] const OFCondition& status() const { return status_; }

 private:
  void keep(const OFCondition& condition) {
    if (status_.good()) status_ = condition;
  }
  OFCondition status_ = EC_Normal;
  DcmItem spare_;
};

/// Text with all that a patient record says, for the identifiers of files that contain it.
std::string print_of(const PatientRecord& patient);

/// Writes the attributes that every file has: character set, SOP class and instance, patient, study, series, modality
/// and equipment. Attributes of which the record says nothing are empty.
/// @param print text with all data of the file, from which its identifiers are derived; the study's too, where the
///   record has none
void fill_common(Filler& fill, DcmDataset& data, const char* sop_class, const char* modality, const std::string& print,
                 const PatientRecord& patient);

/// The bytes of a file that was filled.
/// @param where the file, for messages
/// @param name of the kind of file in messages, such as "RT Plan"
Result<std::string> dicom_bytes(DcmFileFormat& file, const Filler& fill, const std::string& where,
                                E_TransferSyntax syntax, const char* name);

}  // namespace stylet::detail

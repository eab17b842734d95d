// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/dicom_write.hpp"

#include "detail/memory_stream.hpp"
#include "detail/patient_attributes.hpp"
#include "stylet/core/version.hpp"

#include <dcmtk/dcmdata/dcdict.h>
#include <dcmtk/dcmdata/dcostrmf.h>
#include <dcmtk/dcmdata/dcwcache.h>
#include <dcmtk/oflog/oflog.h>
#include <fmt/format.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <boost/uuid/name_generator_sha1.hpp>

namespace stylet::detail {

std::string decimal_string(double value) {
  std::string text = fmt::format("{:.4f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string precise_decimal_string(double value) {
  constexpr std::size_t most = 16;
  std::string text = fmt::format("{}", value);
  for (int digits = 15; text.size() > most && digits > 6; --digits) text = fmt::format("{:.{}g}", value, digits);
  return text == "-0" ? "0" : text;
}

std::string derived_uid(const std::string& content, std::string_view role) {
  static const boost::uuids::uuid name_space{
      {0x8f, 0x14, 0xe4, 0x5f, 0xce, 0xea, 0x46, 0x7a, 0x9b, 0x30, 0x51, 0x0c, 0x6a, 0x2d, 0x77, 0x19}};
  const boost::uuids::uuid id = boost::uuids::name_generator_sha1(name_space)(std::string(role) + '\n' + content);
  boost::multiprecision::uint128_t number = 0;
  for (const std::uint8_t byte : id) number = (number << 8) | byte;
  return "2.25." + number.str();
}

std::string short_text(const std::string& text, std::size_t most) {
  std::string out;
  std::size_t characters = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xc0U) != 0x80U && ++characters > most) break;  // a byte of the form 10… goes on with a character
    out += c == '\\' || byte < 0x20 || byte == 0x7f ? '_' : c;
  }
  return out;
}

Filler::Filler() { OFLog::configure(OFLogger::OFF_LOG_LEVEL); }

std::string print_of(const PatientRecord& patient) {
  std::string text = fmt::format("{}\n{}\n{}\n{}\n", patient.study_uid, patient.frame_of_reference,
                                 patient.position_reference, patient.structure_set);
  for (const PatientAttribute& attribute : kPatientAttributes) text += patient.*attribute.text + '\n';
  return text;
}

void fill_common(Filler& fill, DcmDataset& data, const char* sop_class, const char* modality, const std::string& print,
                 const PatientRecord& patient) {
  fill.text(data, DCM_SpecificCharacterSet, "ISO_IR 192");
  fill.text(data, DCM_SOPClassUID, sop_class);
  fill.text(data, DCM_SOPInstanceUID, derived_uid(print, "instance"));
  fill.text(data, DCM_StudyInstanceUID, patient.study_uid.empty() ? derived_uid(print, "study") : patient.study_uid);
  fill.text(data, DCM_SeriesInstanceUID, derived_uid(print, "series"));
  fill.text(data, DCM_SeriesNumber, "");
  fill.text(data, DCM_SeriesDescription, "Computed by Stylet; research only");
  fill.text(data, DCM_Modality, modality);
  fill.text(data, DCM_Manufacturer, "Stylet");
  fill.text(data, DCM_ManufacturerModelName, "Stylet");
  fill.text(data, DCM_SoftwareVersions, version());
  fill.text(data, DCM_OperatorsName, "");
  for (const PatientAttribute& attribute : kPatientAttributes) {
    const std::string& text = patient.*attribute.text;
    if (attribute.is_always_there || !text.empty()) fill.text(data, attribute.tag, text);
  }
}

Result<std::string> dicom_bytes(DcmFileFormat& file, const Filler& fill, const std::string& where,
                                E_TransferSyntax syntax, const char* name) {
  if (fill.status().bad() && !dcmDataDict.isDictionaryLoaded())
    return failure(where, "the dictionary of DICOM cannot be read", "Install Debian's package libdcmtk17 anew");
  if (fill.status().bad())
    return failure(where, fmt::format("a value of the {} does not fit into a DICOM file", name),
                   "Shorten the names in its input");
  OFCondition status;
  MemoryStream memory;
  {
    DcmOutputFileStream stream(memory.stream());  // closes it
    DcmWriteCache cache;
    file.transferInit();
    status =
        file.write(stream, syntax, EET_UndefinedLength, &cache, EGL_recalcGL, EPD_noChange, 0, 0, 0, EWM_fileformat);
    file.transferEnd();
  }
  if (status.good()) return memory.bytes();
  return failure(where, fmt::format("the {} cannot be made", name), "Correct its input");
}

}  // namespace stylet::detail

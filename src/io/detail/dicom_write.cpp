// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/dicom_write.hpp"

#include "detail/whole_file.hpp"

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

void fill_common(Filler& fill, DcmDataset& data, const char* sop_class, const char* modality,
                 const std::string& print) {
  fill.text(data, DCM_SpecificCharacterSet, "ISO_IR 192");
  fill.text(data, DCM_SOPClassUID, sop_class);
  fill.text(data, DCM_SOPInstanceUID, derived_uid(print, "instance"));
  fill.text(data, DCM_StudyInstanceUID, derived_uid(print, "study"));
  fill.text(data, DCM_SeriesInstanceUID, derived_uid(print, "series"));
  fill.text(data, DCM_Modality, modality);
  fill.text(data, DCM_Manufacturer, "Stylet");
  fill.text(data, DCM_PatientName, "STYLET^PHANTOM");
  fill.text(data, DCM_PatientID, "STYLET");
  for (const DcmTagKey& empty :
       {DCM_PatientBirthDate, DCM_PatientSex, DCM_StudyDate, DCM_StudyTime, DCM_AccessionNumber,
        DCM_ReferringPhysicianName, DCM_StudyID, DCM_SeriesNumber, DCM_OperatorsName}) {
    fill.text(data, empty, "");
  }
}

Result<> save_dicom(DcmFileFormat& file, const Filler& fill, const std::filesystem::path& path, E_TransferSyntax syntax,
                    const char* name) {
  const auto refused = [&](const OFCondition& why) {
    return failure(path.string(), fmt::format("the {} cannot be written ({})", name, why.text()),
                   "Check the folder's permissions and space");
  };
  if (fill.status().bad()) return refused(fill.status());
  return write_whole(path, [&](const std::filesystem::path& temporary) -> Result<> {
    const OFCondition saved = file.saveFile(temporary.c_str(), syntax);
    if (saved.bad()) return refused(saved);
    return Ok{};
  });
}

}  // namespace stylet::detail

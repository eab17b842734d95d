// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet {

/// Whose plan it is: patient, study and frame of reference, as DICOM files of the patient say them. All texts are UTF-8
/// in the notation of DICOM (names "Family^Given", dates "YYYYMMDD", times "HHMMSS"). An empty text: no file says it,
/// and nothing may stand in for it.
struct PatientRecord {
  std::string file;                    ///< DICOM files that say it, separated by commas; empty: there is none
  std::string name;                    ///< patient's name (0010,0010)
  std::string id;                      ///< patient ID (0010,0020)
  std::string id_issuer;               ///< issuer of the patient ID (0010,0021)
  std::string birth_date;              ///< (0010,0030)
  std::string sex;                     ///< "M", "F" or "O" (0010,0040)
  std::string study_uid;               ///< UID of the study (0020,000D)
  std::string study_date, study_time;  ///< (0008,0020), (0008,0030)
  std::string study_id;                ///< (0020,0010)
  std::string study_description;       ///< (0008,1030)
  std::string accession_number;        ///< (0008,0050)
  std::string referring_physician;     ///< (0008,0090)
  std::string frame_of_reference;      ///< UID of the frame of reference (0020,0052)
  std::string position_reference;      ///< position reference indicator (0020,1040)
  std::string structure_set;           ///< SOP instance UID of the structure set on which plan and dose are based

  /// Whether a file says which patient it is.
  [[nodiscard]] bool names_patient() const { return !id.empty() || !name.empty(); }
};

}  // namespace stylet

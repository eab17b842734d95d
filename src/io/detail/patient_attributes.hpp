// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "stylet/dose/patient_record.hpp"

#include <array>
#include <string>

namespace stylet::detail {

/// The form that a text of a patient record must have.
enum class RecordText { any, date, time, sex };

/// An attribute that files of one patient share: read from the inputs and written into the results.
struct PatientAttribute {
  DcmTagKey tag;
  std::string PatientRecord::*text;
  const char* name;  ///< in messages
  RecordText kind;
  bool is_always_there;  ///< type 2: written empty where nothing is known; otherwise left out (type 3)
};

/// The attributes of patient and study (PS3.3 C.7.1.1, C.7.2.1). The study's UID and the frame of reference, which a
/// file must have, are not among them.
inline const std::array<PatientAttribute, 11> kPatientAttributes{{
    {DCM_PatientName, &PatientRecord::name, "patient's name", RecordText::any, true},
    {DCM_PatientID, &PatientRecord::id, "patient ID", RecordText::any, true},
    {DCM_IssuerOfPatientID, &PatientRecord::id_issuer, "issuer of the patient ID", RecordText::any, false},
    {DCM_PatientBirthDate, &PatientRecord::birth_date, "birth date", RecordText::date, true},
    {DCM_PatientSex, &PatientRecord::sex, "patient's sex", RecordText::sex, true},
    {DCM_StudyDate, &PatientRecord::study_date, "study date", RecordText::date, true},
    {DCM_StudyTime, &PatientRecord::study_time, "study time", RecordText::time, true},
    {DCM_StudyID, &PatientRecord::study_id, "study ID", RecordText::any, true},
    {DCM_StudyDescription, &PatientRecord::study_description, "study description", RecordText::any, false},
    {DCM_AccessionNumber, &PatientRecord::accession_number, "accession number", RecordText::any, true},
    {DCM_ReferringPhysicianName, &PatientRecord::referring_physician, "referring physician", RecordText::any, true},
}};

}  // namespace stylet::detail

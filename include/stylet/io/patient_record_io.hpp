// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/patient_record.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet {

/// A patient record with what the user should know of the files that say it.
struct FoundPatient : PatientRecord {
  std::vector<std::string> notes;  ///< sentences: what was left out, and where files differ
};

/// Reads whose file it is: patient, study, frame of reference and structure set of any DICOM file, or of the only
/// structure set or segmentation in a folder. A date, time or sex that DICOM does not allow is left out, with a note.
/// @return a record without `file` for a file of another format, which says nothing of a patient
/// Errors: a file that cannot be read.
Result<FoundPatient> read_patient_record(const std::filesystem::path& path);

/// The files that may say whose plan it is.
struct PatientInputs {
  std::vector<std::filesystem::path> files;  ///< inputs of the command, the plan first; empty paths are passed over
  std::filesystem::path chosen;              ///< the file that decides (--patient-from); empty: the inputs decide
  std::string frame_of_reference;  ///< UID of the frame in which the coordinates of the inputs are; may be empty
  bool ignore_frame = false;       ///< another frame in `chosen` is a warning instead of an error
};

/// Whose plan it is. Without a chosen file, the inputs that say it must agree on the patient; the study is that of the
/// first of them. Nothing is made up: what no file says stays empty. The notes say where files differ.
/// Errors: inputs of different patients; a chosen file that is not DICOM, or that has another frame of reference; those
/// of read_patient_record().
Result<FoundPatient> patient_of(const PatientInputs& inputs);

/// Whose plan it is, as a sentence for the user.
std::string patient_sentence(const PatientRecord& patient);

}  // namespace stylet

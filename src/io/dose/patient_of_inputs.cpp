// SPDX-License-Identifier: GPL-3.0-or-later
// Whose plan it is, where several files say it.
#include "detail/text.hpp"
#include "stylet/io/patient_record_io.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet {

namespace {

constexpr const char* kChoose = "Give files of one patient, or say with --patient-from FILE whose plan it is";

/// A name without what programs write differently: case, and empty parts at its end.
std::string plain_name(const std::string& name) {
  std::string plain = detail::lower(detail::trimmed(name));
  plain.erase(plain.find_last_not_of("^= ") + 1);
  return plain;
}

bool differ(const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; }

/// Whether two files are of different patients: by their IDs where both have one, otherwise by name and birth date.
bool of_other_patient(const PatientRecord& a, const PatientRecord& b) {
  if (!a.id.empty() && !b.id.empty()) return a.id != b.id;
  return differ(plain_name(a.name), plain_name(b.name)) || differ(a.birth_date, b.birth_date);
}

std::string patient_words(const PatientRecord& p) {
  if (!p.names_patient()) return "an unnamed patient";
  const std::string id = p.id.empty() ? "without ID" : "'" + p.id + "'";
  return p.name.empty() ? "patient " + id : fmt::format("patient {} ({})", id, p.name);
}

/// Takes over what a file of the same patient says beyond the record, and notes where they differ.
void add(FoundPatient& record, const FoundPatient& more) {
  const auto take = [&](std::string PatientRecord::*text, const char* name) {
    if ((record.*text).empty()) {
      record.*text = more.*text;
    } else if (differ(record.*text, more.*text)) {
      record.notes.push_back(fmt::format("The {} is '{}' in {} and '{}' in {}; the first is written into the results.",
                                         name, record.*text, record.file, more.*text, more.file));
    }
  };
  if (plain_name(record.name) != plain_name(more.name)) take(&PatientRecord::name, "patient's name");
  take(&PatientRecord::id, "patient ID");
  take(&PatientRecord::id_issuer, "issuer of the patient ID");
  take(&PatientRecord::birth_date, "birth date");
  take(&PatientRecord::sex, "patient's sex");
  if (differ(record.study_uid, more.study_uid)) {
    record.notes.push_back(
        fmt::format("{} and {} are in different studies ({} and {}); the results are put into the first.", record.file,
                    more.file, record.study_uid, more.study_uid));
  } else {
    take(&PatientRecord::study_uid, "study");
    take(&PatientRecord::study_date, "study date");
    take(&PatientRecord::study_time, "study time");
    take(&PatientRecord::study_id, "study ID");
    take(&PatientRecord::study_description, "study description");
    take(&PatientRecord::accession_number, "accession number");
    take(&PatientRecord::referring_physician, "referring physician");
  }
  record.notes.insert(record.notes.end(), more.notes.begin(), more.notes.end());
  record.file += ", " + more.file;
}

/// The records of all inputs that say something.
Result<std::vector<FoundPatient>> read_all(const PatientInputs& inputs) {
  std::vector<FoundPatient> records;
  for (const auto& path : inputs.files) {
    if (path.empty()) continue;
    Result<FoundPatient> record = read_patient_record(path);
    if (!record) return record.error();
    if (!record->file.empty()) records.push_back(*std::move(record));
  }
  return records;
}

Result<FoundPatient> chosen_record(const PatientInputs& inputs, const std::vector<FoundPatient>& records) {
  Result<FoundPatient> record = read_patient_record(inputs.chosen);
  if (!record) return record;
  const std::string where = inputs.chosen.string();
  if (record->file.empty())
    return input_error(where, "--patient-from takes a DICOM file, and this is none",
                       "Name a DICOM file of the patient, such as the structure set");
  if (!record->names_patient())
    record->notes.push_back(where +
                            " says neither the name nor the ID of its patient; they stay empty in the results.");
  for (const FoundPatient& other : records) {
    if (of_other_patient(*record, other))
      record->notes.push_back(fmt::format("{} is of {}; the results are written for {}, as --patient-from says.",
                                          other.file, patient_words(other), patient_words(*record)));
  }
  const std::string frame = record->frame_of_reference;
  if (differ(frame, inputs.frame_of_reference)) {
    const std::string what = fmt::format("it has the frame of reference {}, the coordinates of the inputs have {}",
                                         frame, inputs.frame_of_reference);
    if (!inputs.ignore_frame) return input_error(where, what, "Name a file of the same frame of reference as the plan");
    record->notes.push_back(fmt::format("{}: {}; the results are written with the first, as asked.", where, what));
  }
  return record;
}

/// The record on which the inputs agree.
Result<FoundPatient> common_record(const std::vector<FoundPatient>& records) {
  FoundPatient common;
  for (const FoundPatient& record : records) {
    for (const FoundPatient& other : records) {
      if (!of_other_patient(record, other)) continue;
      return input_error(
          fmt::format("{} and {}", record.file, other.file),
          fmt::format("they are of different patients: {} and {}", patient_words(record), patient_words(other)),
          kChoose);
    }
    if (common.file.empty()) {
      common = record;
    } else {
      add(common, record);
    }
  }
  return common;
}

}  // namespace

Result<FoundPatient> patient_of(const PatientInputs& inputs) {
  Result<std::vector<FoundPatient>> records = read_all(inputs);
  if (!records) return records.error();
  Result<FoundPatient> patient = inputs.chosen.empty() ? common_record(*records) : chosen_record(inputs, *records);
  if (!patient) return patient;
  if (inputs.chosen.empty() || patient->frame_of_reference.empty()) {
    patient->frame_of_reference = inputs.frame_of_reference;
    patient->position_reference.clear();
    for (const FoundPatient& record : *records) {
      if (record.frame_of_reference == inputs.frame_of_reference && patient->position_reference.empty())
        patient->position_reference = record.position_reference;
    }
  }
  if (inputs.chosen.empty() || patient->structure_set.empty()) {
    // A structure set that is given counts more than one that the plan refers to: the doses are those of its
    // structures.
    std::string given;
    for (const FoundPatient& record : *records) {
      if (differ(given, record.structure_set))
        patient->notes.push_back(fmt::format(
            "The plan refers to the structure set {}, and {} is or refers to {}; the results refer to the last.", given,
            record.file, record.structure_set));
      if (!record.structure_set.empty()) given = record.structure_set;
    }
    patient->structure_set = given;
  }
  return patient;
}

std::string patient_sentence(const PatientRecord& patient) {
  if (!patient.names_patient()) {
    return "No input says which patient this is: name, ID and study of the patient are empty in the DICOM results, and "
           "identifiers that must be there are made from their content. --patient-from FILE takes them from a DICOM "
           "file.";
  }
  return fmt::format("The DICOM results are of {}, as in {}.", patient_words(patient), patient.file);
}

}  // namespace stylet

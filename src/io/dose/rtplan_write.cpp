// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of brachytherapy plans in DICOM RTPLAN (DICOM PS3.3 A.20).
#include "detail/dicom_write.hpp"
#include "dose/dose_bytes.hpp"
#include "stylet/core/version.hpp"
#include "stylet/dose/strength_age.hpp"
#include "stylet/io/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace stylet {

namespace {

namespace fs = std::filesystem;
using detail::Filler;
using detail::precise_decimal_string;
using detail::short_text;

const DcmTagKey kOrientation(0x300a, 0x0412);
constexpr const char* kNoDate = "19000101";
constexpr double kSeconds_per_day = 86400.0;
constexpr double kLow_rate_U = 1000.0;                   // sources of low dose rate have less
constexpr double kLow_rate_s = 3600.0;                   // and stay for longer than an hour
constexpr double kMovedFor_s = 30.0 * kSeconds_per_day;  // sources that stay for longer are read as permanent

std::string vector_text(const Vec3& x) {
  return precise_decimal_string(x.x()) + "\\" + precise_decimal_string(x.y()) + "\\" + precise_decimal_string(x.z());
}

/// Text with all data of a plan file, from which its identifiers are derived. Another version of the program may write
/// other attributes, so its files have other identifiers.
std::string print_of(const DosePlan& plan, const SourceModel& source, const PatientRecord& patient) {
  std::string text =
      fmt::format("{}\n{}\n{}\n{}\n{} {}\n{}\n{}", plan.label, plan.frame_of_reference, source.name,
                  plan.prescription_Gy, plan.strength_date, plan.plan_date, version(), detail::print_of(patient));
  for (const PlannedSource& s : plan.sources)
    text +=
        fmt::format("{} {} {} {} {}\n", vector_text(s.at_mm), vector_text(s.axis), s.strength_U, s.dwell_s, s.needle);
  return text;
}

/// Kind of source and strength, which have an item of the source sequence together.
using KindAndStrength = std::pair<std::size_t, double>;

/// Number of the source item for each kind and strength.
std::map<KindAndStrength, int> numbers_of_strengths(const DosePlan& plan) {
  std::map<KindAndStrength, int> numbers;
  for (const PlannedSource& s : plan.sources) numbers.emplace(KindAndStrength(s.kind, s.strength_U), 0);
  int next = 1;
  for (auto& [key, number] : numbers) number = next++;
  return numbers;
}

/// "LDR" or "HDR": sources of low dose rate are weak, and stay for hours or days.
const char* treatment_type(const DosePlan& plan) {
  if (plan.implant == Implant::permanent) return "LDR";
  double strongest_U = 0.0, longest_s = 0.0;
  for (const PlannedSource& s : plan.sources) {
    strongest_U = std::max(strongest_U, s.strength_U);
    longest_s = std::max(longest_s, s.dwell_s);
  }
  return strongest_U < kLow_rate_U && longest_s > kLow_rate_s && longest_s < kMovedFor_s ? "LDR" : "HDR";
}

void fill_plan(Filler& fill, DcmDataset& data, const DosePlan& plan, const std::string& print,
               const PatientRecord& patient) {
  detail::fill_common(fill, data, UID_RTPlanStorage, "RTPLAN", print, patient);
  fill.text(data, DCM_InstanceNumber, "1");
  fill.text(data, DCM_FrameOfReferenceUID, patient.frame_of_reference);
  fill.text(data, DCM_PositionReferenceIndicator, patient.position_reference);
  fill.text(data, DCM_RTPlanLabel, plan.label.empty() ? "Stylet" : short_text(plan.label, 16));  // VR SH
  if (!plan.label.empty()) fill.text(data, DCM_RTPlanName, short_text(plan.label, 64));          // VR LO
  const auto date = parse_date_time(plan.plan_date);
  fill.text(data, DCM_RTPlanDate, date ? date->dicom_date() : "");
  fill.text(data, DCM_RTPlanTime, date ? date->dicom_time() : "");
  fill.text(data, DCM_ApprovalStatus, "UNAPPROVED");
  fill.text(data, DCM_RTPlanGeometry, patient.structure_set.empty() ? "TREATMENT_DEVICE" : "PATIENT");
  if (!patient.structure_set.empty()) {
    DcmItem& reference = fill.new_item(data, DCM_ReferencedStructureSetSequence);
    fill.text(reference, DCM_ReferencedSOPClassUID, UID_RTStructureSetStorage);
    fill.text(reference, DCM_ReferencedSOPInstanceUID, patient.structure_set);
  }
  fill.text(data, DCM_BrachyTreatmentTechnique, plan.implant == Implant::permanent ? "PERMANENT" : "INTERSTITIAL");
  fill.text(data, DCM_BrachyTreatmentType, treatment_type(plan));
  if (plan.prescription_Gy > 0.0) {
    DcmItem& reference = fill.new_item(data, DCM_DoseReferenceSequence);
    fill.text(reference, DCM_DoseReferenceNumber, "1");
    fill.text(reference, DCM_DoseReferenceStructureType, "SITE");
    fill.text(reference, DCM_DoseReferenceDescription, "Target");
    fill.text(reference, DCM_DoseReferenceType, "TARGET");
    fill.text(reference, DCM_TargetPrescriptionDose, precise_decimal_string(plan.prescription_Gy));
  }
  DcmItem& group = fill.new_item(data, DCM_FractionGroupSequence);
  fill.text(group, DCM_FractionGroupNumber, "1");
  fill.text(group, DCM_NumberOfFractionsPlanned, "1");
  fill.text(group, DCM_NumberOfBeams, "0");
  fill.text(group, DCM_NumberOfBrachyApplicationSetups, "1");
  DcmItem& setup = fill.new_item(group, DCM_ReferencedBrachyApplicationSetupSequence);
  fill.text(setup, DCM_ReferencedBrachyApplicationSetupNumber, "1");
  if (plan.prescription_Gy > 0.0)
    fill.text(setup, DCM_BrachyApplicationSetupDose, precise_decimal_string(plan.prescription_Gy));
  fill.text(fill.new_item(data, DCM_TreatmentMachineSequence), DCM_TreatmentMachineName, "");
}

/// One source for each strength. DICOM asks for a date of the strength; 1900-01-01 stands for one that is not known.
void fill_sources(Filler& fill, DcmDataset& data, const DosePlan& plan, const SourceModel& source) {
  for (const auto& [key, number] : numbers_of_strengths(plan)) {
    const auto& [kind, strength] = key;
    SourceKind says{"", source.name, source.isotope, source.half_life_days, source.active_length_mm, 0.0, ""};
    if (kind > 0) says = source_kind(plan, kind);
    DcmItem& item = fill.new_item(data, DCM_SourceSequence);
    fill.text(item, DCM_SourceNumber, std::to_string(number));
    fill.text(item, DCM_SourceType, "LINE");
    fill.text(item, DCM_SourceManufacturer, "");
    fill.text(item, DCM_SourceDescription, short_text(says.source_model, 64));
    fill.text(item, DCM_ActiveSourceLength, precise_decimal_string(says.source_length_mm));
    fill.text(item, DCM_SourceIsotopeName, says.isotope);
    fill.text(item, DCM_SourceIsotopeHalfLife, precise_decimal_string(says.half_life_days));
    fill.text(item, DcmTagKey(0x300a, 0x0229), "AIR_KERMA_RATE");
    fill.text(item, DCM_ReferenceAirKermaRate, precise_decimal_string(strength));
    // SourceStrength is for sources without an air-kerma rate. Programs that read the rate as a whole number find none
    // below 1 U and ask for it.
    if (strength < 1.0) fill.text(item, DcmTagKey(0x300a, 0x022b), precise_decimal_string(strength));
    const auto date = parse_date_time(plan.strength_date);
    fill.text(item, DCM_SourceStrengthReferenceDate, date ? date->dicom_date() : kNoDate);
    fill.text(item, DCM_SourceStrengthReferenceTime, date && date->seconds >= 0 ? date->dicom_time() : "000000");
  }
}

/// @param from_tip_mm distance of the source from the place of its channel that is nearest the tip, along the channel
void fill_point(Filler& fill, DcmItem& channel, int index, double weight, double from_tip_mm, const PlannedSource& s) {
  DcmItem& point = fill.new_item(channel, DCM_BrachyControlPointSequence);
  fill.text(point, DCM_ControlPointIndex, std::to_string(index));
  fill.text(point, DCM_CumulativeTimeWeight, precise_decimal_string(weight));
  fill.text(point, DCM_ControlPointRelativePosition, precise_decimal_string(from_tip_mm));
  fill.text(point, DCM_ControlPoint3DPosition, vector_text(s.at_mm));
  if (!s.has_axis) return;
  const std::vector<Float32> axis{static_cast<Float32>(s.axis.x()), static_cast<Float32>(s.axis.y()),
                                  static_cast<Float32>(s.axis.z())};
  fill.floats(point, kOrientation, axis);
}

/// Sources of one channel: one seed, or all dwell positions of a needle with one strength, in the order of the plan.
std::vector<std::vector<const PlannedSource*>> channels_of(const DosePlan& plan) {
  std::vector<std::vector<const PlannedSource*>> channels;
  std::map<std::pair<std::string, KindAndStrength>, std::size_t> known;
  for (const PlannedSource& s : plan.sources) {
    if (plan.implant == Implant::permanent || s.needle.empty()) {
      channels.push_back({&s});
      continue;
    }
    const auto [found, is_new] =
        known.emplace(std::pair(s.needle, KindAndStrength(s.kind, s.strength_U)), channels.size());
    if (is_new) channels.emplace_back();
    channels[found->second].push_back(&s);
  }
  return channels;
}

/// The places of a channel along it.
struct ChannelPlaces {
  std::vector<double> from_tip_mm;  ///< of each source [mm], along the line through the sources
  double step_mm = 0.0;             ///< least distance of neighbours [mm]; 0: all sources are at one place
};

ChannelPlaces places_of(const std::vector<const PlannedSource*>& members) {
  constexpr double same_place_mm = 0.01;
  ChannelPlaces places;
  double along = 0.0, towards_tip = 0.0;
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (k > 0) {
      const Vec3 way = members[k]->at_mm - members[k - 1]->at_mm;
      along += way.norm();
      if (way.norm() > same_place_mm && (places.step_mm == 0.0 || way.norm() < places.step_mm))
        places.step_mm = way.norm();
      if (members[k]->has_axis) towards_tip += way.dot(members[k]->axis);  // axes point to the tip
    }
    places.from_tip_mm.push_back(along);
  }
  if (towards_tip > 0.0) {
    for (double& distance : places.from_tip_mm) distance = along - distance;
  }
  return places;
}

void fill_channels(Filler& fill, DcmDataset& data, const DosePlan& plan, const SourceModel& source) {
  const bool permanent = plan.implant == Implant::permanent;
  const auto numbers = numbers_of_strengths(plan);
  DcmItem& setup = fill.new_item(data, DCM_ApplicationSetupSequence);
  fill.text(setup, DCM_ApplicationSetupType, "PERINEAL");
  fill.text(setup, DCM_ApplicationSetupNumber, "1");
  double kerma = 0.0;
  for (const PlannedSource& s : plan.sources) {
    const double half_life_days = s.kind > 0 ? source_kind(plan, s.kind).half_life_days : source.half_life_days;
    const double hours = permanent ? half_life_days * 24.0 / std::numbers::ln2 : s.dwell_s / 3600.0;
    kerma += s.strength_U * hours;
  }
  fill.text(setup, DCM_TotalReferenceAirKerma, precise_decimal_string(kerma));
  int number = 0;
  for (const auto& members : channels_of(plan)) {
    DcmItem& channel = fill.new_item(setup, DCM_ChannelSequence);
    const std::size_t kind = members.front()->kind;
    const double half_life_days = kind > 0 ? source_kind(plan, kind).half_life_days : source.half_life_days;
    double total_s = permanent ? half_life_days * kSeconds_per_day / std::numbers::ln2 : 0.0;
    if (!permanent) {
      for (const PlannedSource* s : members) total_s += s->dwell_s;
    }
    fill.text(channel, DCM_ChannelNumber, std::to_string(++number));
    fill.text(channel, DCM_ChannelLength, "");
    fill.text(channel, DCM_ChannelTotalTime, precise_decimal_string(total_s));
    const ChannelPlaces places = places_of(members);
    const bool steps = !permanent && places.step_mm > 0.0;
    fill.text(channel, DCM_SourceMovementType, steps ? "STEPWISE" : "FIXED");
    if (steps) fill.text(channel, DCM_SourceApplicatorStepSize, detail::decimal_string(places.step_mm));
    fill.text(channel, DCM_ReferencedSourceNumber,
              std::to_string(numbers.at({members.front()->kind, members.front()->strength_U})));
    // A number of the applicator would ask for its length and for the structure that shows it.
    if (const std::string& needle = members.front()->needle; !needle.empty())
      fill.text(channel, DCM_SourceApplicatorName, short_text(needle, 64));
    fill.text(channel, DCM_TransferTubeNumber, "");
    fill.text(channel, DCM_NumberOfControlPoints, std::to_string(2 * members.size()));
    double weight = 0.0;
    int index = 0;
    for (std::size_t k = 0; k < members.size(); ++k) {
      fill_point(fill, channel, index++, weight, places.from_tip_mm[k], *members[k]);
      weight += permanent ? 1.0 : members[k]->dwell_s;
      fill_point(fill, channel, index++, weight, places.from_tip_mm[k], *members[k]);
    }
    fill.text(channel, DCM_FinalCumulativeTimeWeight, precise_decimal_string(weight));
  }
}

}  // namespace

PatientRecord record_of_files(PatientRecord patient, const DosePlan& plan, const SourceModel& source) {
  if (patient.frame_of_reference.empty()) patient.frame_of_reference = plan.frame_of_reference;
  const std::string print = print_of(plan, source, patient);
  if (patient.frame_of_reference.empty()) patient.frame_of_reference = detail::derived_uid(print, "frame");
  if (patient.study_uid.empty()) patient.study_uid = detail::derived_uid(print, "study");
  return patient;
}

std::string rtplan_uid(const DosePlan& plan, const SourceModel& source, const PatientRecord& patient) {
  return detail::derived_uid(print_of(plan, source, record_of_files(patient, plan, source)), "instance");
}

Result<std::string> rtplan_bytes(const DosePlan& plan, const SourceModel& source, const std::string& where,
                                 const PatientRecord& patient) {
  for (const PlannedSource& s : plan.sources) {
    if (!s.at_mm.allFinite() || !s.axis.allFinite() || !std::isfinite(s.strength_U) || !std::isfinite(s.dwell_s))
      return failure(where, "a source of the plan has a number that is not finite", "Correct the plan");
  }
  DcmFileFormat file;
  Filler fill;
  const PatientRecord record = record_of_files(patient, plan, source);
  fill_plan(fill, *file.getDataset(), plan, print_of(plan, source, record), record);
  fill_sources(fill, *file.getDataset(), plan, source);
  fill_channels(fill, *file.getDataset(), plan, source);
  return detail::dicom_bytes(file, fill, where, EXS_LittleEndianExplicit, "RT Plan");
}

Result<> write_rtplan(const DosePlan& plan, const SourceModel& source, const fs::path& path,
                      const PatientRecord& patient) {
  auto bytes = rtplan_bytes(plan, source, path.string(), patient);
  if (!bytes) return bytes.error();
  return write_whole_file(path, *bytes);
}

}  // namespace stylet

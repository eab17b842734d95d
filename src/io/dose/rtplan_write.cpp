// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of brachytherapy plans in DICOM RTPLAN (DICOM PS3.3 A.20), without patient-identifying data.
#include "detail/dicom_write.hpp"
#include "stylet/io/dose_io.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

namespace stylet {

namespace {

namespace fs = std::filesystem;
using detail::Filler;
using detail::precise_decimal_string;

const DcmTagKey kOrientation(0x300a, 0x0412);
constexpr const char* kNoDate = "19000101";
constexpr double kSeconds_per_day = 86400.0;

std::string vector_text(const Vec3& x) {
  return precise_decimal_string(x.x()) + "\\" + precise_decimal_string(x.y()) + "\\" + precise_decimal_string(x.z());
}

/// Text with all data of a plan, from which its identifiers are derived.
std::string print_of(const DosePlan& plan, const SourceModel& source) {
  std::string text =
      fmt::format("{}\n{}\n{}\n{}\n", plan.label, plan.frame_of_reference, source.name, plan.prescription_Gy);
  for (const PlannedSource& s : plan.sources)
    text +=
        fmt::format("{} {} {} {} {}\n", vector_text(s.at_mm), vector_text(s.axis), s.strength_U, s.dwell_s, s.needle);
  return text;
}

/// Number of the source item for each strength.
std::map<double, int> numbers_of_strengths(const DosePlan& plan) {
  std::map<double, int> numbers;
  for (const PlannedSource& s : plan.sources) numbers.emplace(s.strength_U, 0);
  int next = 1;
  for (auto& [strength, number] : numbers) number = next++;
  return numbers;
}

void fill_plan(Filler& fill, DcmDataset& data, const DosePlan& plan, const std::string& print,
               const std::string& frame) {
  const bool permanent = plan.implant == Implant::permanent;
  detail::fill_common(fill, data, UID_RTPlanStorage, "RTPLAN", print);
  fill.text(data, DCM_FrameOfReferenceUID, frame);
  fill.text(data, DCM_PositionReferenceIndicator, "");
  fill.text(data, DCM_RTPlanLabel, plan.label.empty() ? "Stylet" : plan.label.substr(0, 16));  // SH: 16 characters
  fill.text(data, DCM_RTPlanDate, "");
  fill.text(data, DCM_RTPlanTime, "");
  fill.text(data, DCM_RTPlanGeometry, "TREATMENT_DEVICE");
  fill.text(data, DCM_BrachyTreatmentTechnique, permanent ? "PERMANENT" : "INTERSTITIAL");
  fill.text(data, DCM_BrachyTreatmentType, permanent ? "LDR" : "HDR");
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

/// Date and time of DICOM from "20240102 101500"; midnight where there is no time.
std::pair<std::string, std::string> date_and_time(const std::string& text) {
  const auto digits = [&](std::size_t from, std::size_t count) {
    const std::string part = text.size() < from + count ? "" : text.substr(from, count);
    return part.find_first_not_of("0123456789") == std::string::npos ? part : "";
  };
  const std::string date = digits(0, 8);
  const std::string time = digits(9, 6);
  return {date.empty() ? kNoDate : date, date.empty() || time.empty() ? "000000" : time};
}

/// One source for each strength. DICOM asks for a date of the strength; 1900-01-01 stands for one that is not known.
void fill_sources(Filler& fill, DcmDataset& data, const DosePlan& plan, const SourceModel& source) {
  for (const auto& [strength, number] : numbers_of_strengths(plan)) {
    DcmItem& item = fill.new_item(data, DCM_SourceSequence);
    fill.text(item, DCM_SourceNumber, std::to_string(number));
    fill.text(item, DCM_SourceType, "LINE");
    fill.text(item, DCM_SourceManufacturer, "");
    fill.text(item, DCM_SourceDescription, source.name);
    fill.text(item, DCM_ActiveSourceLength, precise_decimal_string(source.active_length_mm));
    fill.text(item, DCM_SourceIsotopeName, source.isotope);
    fill.text(item, DCM_SourceIsotopeHalfLife, precise_decimal_string(source.half_life_days));
    fill.text(item, DCM_ReferenceAirKermaRate, precise_decimal_string(strength));
    const auto [date, time] = date_and_time(plan.strength_date);
    fill.text(item, DCM_SourceStrengthReferenceDate, date);
    fill.text(item, DCM_SourceStrengthReferenceTime, time);
  }
}

void fill_point(Filler& fill, DcmItem& channel, int index, double weight, const PlannedSource& s) {
  DcmItem& point = fill.new_item(channel, DCM_BrachyControlPointSequence);
  fill.text(point, DCM_ControlPointIndex, std::to_string(index));
  fill.text(point, DCM_CumulativeTimeWeight, precise_decimal_string(weight));
  fill.text(point, DCM_ControlPointRelativePosition, std::to_string(index / 2));
  fill.text(point, DCM_ControlPoint3DPosition, vector_text(s.at_mm));
  if (!s.has_axis) return;
  const std::vector<Float32> axis{static_cast<Float32>(s.axis.x()), static_cast<Float32>(s.axis.y()),
                                  static_cast<Float32>(s.axis.z())};
  fill.floats(point, kOrientation, axis);
}

/// Sources of one channel: one seed, or all dwell positions of a needle with one strength, in the order of the plan.
std::vector<std::vector<const PlannedSource*>> channels_of(const DosePlan& plan) {
  std::vector<std::vector<const PlannedSource*>> channels;
  std::map<std::pair<std::string, double>, std::size_t> known;
  for (const PlannedSource& s : plan.sources) {
    if (plan.implant == Implant::permanent || s.needle.empty()) {
      channels.push_back({&s});
      continue;
    }
    const auto [found, is_new] = known.emplace(std::pair(s.needle, s.strength_U), channels.size());
    if (is_new) channels.emplace_back();
    channels[found->second].push_back(&s);
  }
  return channels;
}

void fill_channels(Filler& fill, DcmDataset& data, const DosePlan& plan, const SourceModel& source) {
  const bool permanent = plan.implant == Implant::permanent;
  const auto numbers = numbers_of_strengths(plan);
  DcmItem& setup = fill.new_item(data, DCM_ApplicationSetupSequence);
  fill.text(setup, DCM_ApplicationSetupType, "TEMPLATE");
  fill.text(setup, DCM_ApplicationSetupNumber, "1");
  double kerma = 0.0;
  for (const PlannedSource& s : plan.sources) {
    const double hours = permanent ? source.half_life_days * 24.0 / std::numbers::ln2 : s.dwell_s / 3600.0;
    kerma += s.strength_U * hours;
  }
  fill.text(setup, DCM_TotalReferenceAirKerma, precise_decimal_string(kerma));
  int number = 0;
  for (const auto& members : channels_of(plan)) {
    DcmItem& channel = fill.new_item(setup, DCM_ChannelSequence);
    double total_s = permanent ? source.half_life_days * kSeconds_per_day / std::numbers::ln2 : 0.0;
    if (!permanent) {
      for (const PlannedSource* s : members) total_s += s->dwell_s;
    }
    fill.text(channel, DCM_ChannelNumber, std::to_string(++number));
    fill.text(channel, DCM_ChannelLength, "");
    fill.text(channel, DCM_ChannelTotalTime, precise_decimal_string(total_s));
    fill.text(channel, DCM_SourceMovementType, permanent ? "FIXED" : "STEPWISE");
    fill.text(channel, DCM_ReferencedSourceNumber, std::to_string(numbers.at(members.front()->strength_U)));
    const std::string needle = members.front()->needle.substr(0, 16);
    if (!needle.empty()) {
      fill.text(channel, DCM_SourceApplicatorNumber, std::to_string(number));
      fill.text(channel, DCM_SourceApplicatorID, needle);
      fill.text(channel, DCM_SourceApplicatorType, permanent ? "RIGID" : "FLEXIBLE");
    }
    fill.text(channel, DCM_TransferTubeNumber, "");
    fill.text(channel, DCM_NumberOfControlPoints, std::to_string(2 * members.size()));
    double weight = 0.0;
    int index = 0;
    for (const PlannedSource* s : members) {
      fill_point(fill, channel, index++, weight, *s);
      weight += permanent ? 1.0 : s->dwell_s;
      fill_point(fill, channel, index++, weight, *s);
    }
    fill.text(channel, DCM_FinalCumulativeTimeWeight, precise_decimal_string(weight));
  }
}

}  // namespace

std::string rtplan_uid(const DosePlan& plan, const SourceModel& source) {
  return detail::derived_uid(print_of(plan, source), "instance");
}

std::string rtplan_frame(const DosePlan& plan, const SourceModel& source) {
  return plan.frame_of_reference.empty() ? detail::derived_uid(print_of(plan, source), "frame")
                                         : plan.frame_of_reference;
}

Result<> write_rtplan(const DosePlan& plan, const SourceModel& source, const fs::path& path) {
  for (const PlannedSource& s : plan.sources) {
    if (!s.at_mm.allFinite() || !s.axis.allFinite() || !std::isfinite(s.strength_U) || !std::isfinite(s.dwell_s))
      return failure(path.string(), "a source of the plan has a number that is not finite", "Correct the plan");
  }
  DcmFileFormat file;
  Filler fill;
  fill_plan(fill, *file.getDataset(), plan, print_of(plan, source), rtplan_frame(plan, source));
  fill_sources(fill, *file.getDataset(), plan, source);
  fill_channels(fill, *file.getDataset(), plan, source);
  return detail::save_dicom(file, fill, path, EXS_LittleEndianExplicit, "RT Plan");
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of brachytherapy plans in DICOM RTPLAN (DICOM PS3.3 A.20, C.8.8.10 to C.8.8.15).
#include "detail/dicom.hpp"
#include "detail/reach.hpp"
#include "detail/text.hpp"
#include "dose/dose_parsers.hpp"
#include "dose/rtplan_channel.hpp"
#include "stylet/dose/known_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

constexpr const char* kExportPlanAgain = "The file is damaged; export the plan again";
constexpr const char* kNoDate = "19000101";  // stands for no date, also in our own files
constexpr double kSameSeed_mm = 0.01;
constexpr double kSeconds_per_day = 86400.0;
constexpr double kStays_days = 30.0;          // sources that are left for longer are not taken out
constexpr double kLeast_low_rate_s = 3600.0;  // shortest implant of low dose rate

const DcmTagKey kControlPointOrientation(0x300a, 0x0412);
const DcmTagKey kSourceStrengthUnits(0x300a, 0x0229);

std::optional<double> number_of(DcmItem& item, const DcmTagKey& tag) {
  const auto numbers = numbers_of(item, tag);
  return numbers.size() == 1 ? std::optional(numbers.front()) : std::nullopt;
}

std::optional<Vec3> vector_of(DcmItem& item, const DcmTagKey& tag) {
  const auto numbers = numbers_of(item, tag);
  if (numbers.size() != 3) return std::nullopt;
  return Vec3(numbers[0], numbers[1], numbers[2]);
}

/// One item of the source sequence (300A,0210).
struct PlanSource {
  std::string isotope, model, strength_text, date, units;
  bool used = false;  // by a channel
  double half_life_days = 0.0, length_mm = 0.0, diameter_mm = 0.0;
};

/// Reads one plan; holds what its parts share.
class RtplanReader {
 public:
  RtplanReader(DcmDataset& data, const std::string& file) : data_(data) { plan_.file = file; }

  Result<DosePlan> run() {
    plan_.uid = text_of(data_, DCM_SOPInstanceUID);
    plan_.label = text_of(data_, DCM_RTPlanLabel);
    plan_.frame_of_reference = text_of(data_, DCM_FrameOfReferenceUID);
    plan_.plan_date = trimmed(text_of(data_, DCM_RTPlanDate) + " " + text_of(data_, DCM_RTPlanTime));
    plan_.says.is_dicom = true;
    plan_.says.has_beams = !items_of(data_, DCM_BeamSequence).empty();
    read_sources();
    const auto setups = items_of(data_, DCM_ApplicationSetupSequence);
    if (setups.empty()) {
      return input_error(plan_.file, "the plan has no brachytherapy application setups (300A,0230)",
                         items_of(data_, DCM_BeamSequence).empty()
                             ? "Export the plan with its sources"
                             : "Name a brachytherapy plan; this one has external beams");
    }
    if (Result<> known = choose_implant(setups); !known) return known.error();
    int number = 0;
    for (DcmItem* setup : setups) {
      if (Result<> read = read_setup(*setup, ++number); !read) return read.error();
    }
    if (other_strengths_ > 0) {
      plan_.notes.push_back(
          fmt::format("{} of the seeds that stand in the plan again have another strength there; the first one counts.",
                      other_strengths_));
    }
    if (repeated_ > 0) {
      plan_.notes.push_back(fmt::format(
          "{} seed{} stand{} twice or more in the plan at the same place, as in plans whose setups repeat a "
          "common one; each counts once.",
          repeated_, repeated_ == 1 ? "" : "s", repeated_ == 1 ? "s" : ""));
    }
    if (plan_.sources.empty()) {
      return input_error(plan_.file, "no channel of the plan has a source that stays anywhere",
                         "Export the plan with its seeds or dwell times");
    }
    if (turned_by_channel_ > 0) {
      plan_.notes.push_back(
          fmt::format("{} dwell positions have no orientation (300A,0412); it is taken from the line through their "
                      "neighbours in the "
                      "channel.",
                      turned_by_channel_));
    }
    for (const auto& [source_number, source] : sources_) {
      const auto strength = to_number(source.strength_text);
      if (!source.used && source.half_life_days > 0.0 && strength && *strength > 0.0)
        plan_.says.unused.push_back(fmt::format("{} ({}, {:g} U)", source_number, source.isotope, *strength));
    }
    read_prescription();
    return std::move(plan_);
  }

 private:
  void read_sources() {
    for (DcmItem* item : items_of(data_, DCM_SourceSequence)) {
      PlanSource source;
      source.isotope = text_of(*item, DCM_SourceIsotopeName);
      source.model = text_of(*item, DCM_SourceDescription);
      source.strength_text = text_of(*item, DCM_ReferenceAirKermaRate);
      source.units = text_of(*item, kSourceStrengthUnits);
      const bool no_half_life = text_of(*item, DCM_SourceIsotopeHalfLife).empty();
      source.half_life_days = number_of(*item, DCM_SourceIsotopeHalfLife).value_or(no_half_life ? 0.0 : -1.0);
      source.length_mm = number_of(*item, DCM_ActiveSourceLength).value_or(0.0);
      source.diameter_mm = number_of(*item, DCM_ActiveSourceDiameter).value_or(0.0);
      source.date = trimmed(text_of(*item, DCM_SourceStrengthReferenceDate) + " " +
                            text_of(*item, DCM_SourceStrengthReferenceTime));
      if (source.date.starts_with(kNoDate)) source.date.clear();
      sources_[integer_of(*item, DCM_SourceNumber).value_or(static_cast<int>(sources_.size()))] = source;
    }
  }

  /// Whether the seeds stay: the technique says it, or the type, or the times of the channels.
  Result<> choose_implant(const std::vector<DcmItem*>& setups) {
    const std::string technique = plan_.says.technique = text_of(data_, DCM_BrachyTreatmentTechnique);
    const std::string type = plan_.says.type = text_of(data_, DCM_BrachyTreatmentType);
    double longest_s = 0.0;
    for (DcmItem* setup : setups) {
      for (DcmItem* channel : items_of(*setup, DCM_ChannelSequence))
        longest_s = std::max(longest_s, number_of(*channel, DCM_ChannelTotalTime).value_or(0.0));
    }
    plan_.says.longest_channel_s = longest_s;
    if (technique == "PERMANENT") return Ok{};
    if (type == "HDR" || type == "PDR" || type == "MDR") {
      plan_.implant = Implant::temporary;
      if (type == "PDR") {
        pulsed_ = true;
        plan_.notes.emplace_back(
            "The plan is pulsed (PDR); the times of each channel are multiplied by its number of pulses (300A,028A), "
            "and "
            "the dose is that of all pulses together.");
      }
      return Ok{};
    }
    double half_life = 0.0;
    for (const auto& [number, source] : sources_) half_life = std::max(half_life, source.half_life_days);
    const double mean_life_days = half_life > 0.0 ? half_life / std::numbers::ln2 : 1e9;
    const bool stays = longest_s <= 0.0 || longest_s > kSeconds_per_day * std::min(kStays_days, 0.9 * mean_life_days);
    if (type == "LDR" || type == "MANUAL") {
      // Some programs give seeds that stay a time of a second or so, which no implant of low dose rate has.
      if (!stays && longest_s > kLeast_low_rate_s) {
        plan_.implant = Implant::temporary;
        plan_.notes.push_back(fmt::format(
            "The plan is {} with sources that are taken out after at most {:.4g} h; it is computed as temporary.", type,
            longest_s / 3600.0));
      }
      return Ok{};
    }
    if (type.empty() && stays && half_life > 0.0) {
      plan_.notes.emplace_back(
          "The plan does not say its type (300A,0202); its times are those of seeds that stay, so it is computed as "
          "permanent.");
      return Ok{};
    }
    return input_error(
        plan_.file,
        fmt::format("the brachytherapy type (300A,0202) is '{}'; LDR, HDR, PDR, MDR or MANUAL is expected",
                    type.empty() ? "(missing)" : type),
        "Export the plan with its type");
  }

  Result<> read_setup(DcmItem& setup, int number) {
    const double kerma = number_of(setup, DCM_TotalReferenceAirKerma).value_or(0.0);
    if (kerma > 0.0) plan_.says.total_kermas.push_back(kerma);
    for (DcmItem* channel : items_of(setup, DCM_ChannelSequence)) {
      ++channels_;
      const std::string where = fmt::format("{}, application setup {}, channel {}", plan_.file, number,
                                            integer_of(*channel, DCM_ChannelNumber).value_or(channels_));
      if (Result<> read = read_channel(*channel, where); !read) return read;
    }
    return Ok{};
  }

  Result<double> strength_of(const PlanSource& source, int number, const std::string& where) {
    if (!source.units.empty() && source.units != "AIR_KERMA_RATE") {
      return input_error(where,
                         fmt::format("the strength of source {} is given as {} (300A,0229)", number, source.units),
                         "Export the plan with the air-kerma strength of its sources");
    }
    const auto strength = to_number(source.strength_text);
    if (strength && std::isfinite(*strength) && *strength > 0.0) return *strength;
    return input_error(
        where,
        fmt::format("source {} has the strength '{}' (ReferenceAirKermaRate, 300A,022A); a number above 0 "
                    "in µGy/h at 1 m is expected",
                    number, source.strength_text.empty() ? "(missing)" : source.strength_text),
        "Enter the air-kerma strength in the planning system and export the plan again");
  }

  Result<> read_channel(DcmItem& channel, const std::string& where) {
    std::vector<ControlPoint> points;
    for (DcmItem* item : items_of(channel, DCM_BrachyControlPointSequence)) {
      ControlPoint point;
      const auto weight = number_of(*item, DCM_CumulativeTimeWeight);
      if (!weight && !text_of(*item, DCM_CumulativeTimeWeight).empty()) {
        return input_error(fmt::format("{}, control point {}", where, points.size() + 1),
                           fmt::format("its cumulative time weight (300A,02D6) is '{}', a number is expected",
                                       text_of(*item, DCM_CumulativeTimeWeight)),
                           kExportPlanAgain);
      }
      point.weight = weight.value_or(0.0);
      if (const auto at = vector_of(*item, DCM_ControlPoint3DPosition)) {
        point.at_mm = *at;
        point.has_place = true;
        if (Result<> reach = check_reach(where, *at, fmt::format("control point {}", points.size() + 1)); !reach)
          return reach;
      }
      const auto axis = vector_of(*item, kControlPointOrientation);
      if (axis && axis->norm() > 1e-6) point.axis = axis->normalized();
      points.push_back(point);
    }
    plan_.says.channels.push_back(says_of(channel, points, where));
    if (points.empty()) return Ok{};
    const bool seeds = plan_.implant == Implant::permanent;
    Result<std::vector<RestingPlace>> places = resting_places(points, seeds, where);
    if (!places) return places.error();
    for (const RestingPlace& place : *places) plan_.says.channels.back().weights += place.weight;
    if (places->empty()) return Ok{};
    const auto number = source_number(channel, where);
    if (!number) return number.error();
    PlanSource& source = sources_.at(*number);
    source.used = true;
    const Result<double> strength = strength_of(source, *number, where);
    if (!strength) return strength.error();
    double seconds_per_weight = 0.0, over_s = 0.0;
    if (!seeds) {
      const double total_s = number_of(channel, DCM_ChannelTotalTime).value_or(0.0);
      const double last = number_of(channel, DCM_FinalCumulativeTimeWeight).value_or(points.back().weight);
      if (total_s < 0.0 || (total_s > 0.0 && last <= 0.0)) {
        return input_error(
            where, fmt::format("the channel lasts {:g} s and its final cumulative time weight is {:g}", total_s, last),
            kExportPlanAgain);
      }
      if (total_s <= 0.0) return Ok{};
      double weights = 0.0;
      for (const RestingPlace& place : *places) weights += place.weight;
      const int pulses = pulsed_ ? std::max(1, integer_of(channel, DCM_NumberOfPulses).value_or(1)) : 1;
      seconds_per_weight = pulses * total_s / weights;
      over_s = pulses > 1 ? pulses * number_of(channel, DCM_PulseRepetitionInterval).value_or(0.0) : 0.0;
      turn_by_neighbours(*places, begins_at_tip(channel));
    }
    PlannedSource common;
    common.kind = kind_of(*number, source);
    common.strength_U = *strength;
    common.over_s = over_s;
    common.needle = needle_of(channel, places->size());
    add_places(*places, seconds_per_weight, common);
    return Ok{};
  }

  /// Number of the source of a channel.
  Result<int> source_number(DcmItem& channel, const std::string& where) {
    const auto number = integer_of(channel, DCM_ReferencedSourceNumber);
    if (number && sources_.contains(*number)) return *number;
    if (!number && sources_.size() == 1) return sources_.begin()->first;
    return input_error(
        where,
        number ? fmt::format("it refers to source {}, which the plan does not have (300A,0210)", *number)
               : fmt::format("it does not say which of the plan's {} sources it has (300C,000E)", sources_.size()),
        kExportPlanAgain);
  }

  /// Number of the kind of a source; sources that differ in their strength only are of one kind.
  std::size_t kind_of(int number, const PlanSource& source) {
    const auto [known, is_new] = kinds_.emplace(number, 0);
    if (!is_new) return known->second;
    SourceKind kind;
    kind.id = std::to_string(number);
    kind.isotope = source.isotope;
    // Planning systems leave the model out or have names of their own; this program writes the name that it knows.
    if (find_source(source.model).ok()) kind.source_model = source.model;
    kind.half_life_days = source.half_life_days;
    kind.source_length_mm = source.length_mm;
    kind.source_diameter_mm = source.diameter_mm;
    kind.strength_date = source.date;
    if (plan_.sources.empty()) {
      plan_.source_id = kind.id;
      plan_.source_model = kind.source_model;
      plan_.isotope = kind.isotope;
      plan_.half_life_days = kind.half_life_days;
      plan_.source_length_mm = kind.source_length_mm;
      plan_.source_diameter_mm = kind.source_diameter_mm;
      plan_.strength_date = kind.strength_date;
      return 0;
    }
    for (std::size_t k = 0; k < kind_count(plan_); ++k) {
      const SourceKind other = source_kind(plan_, k);
      if (other.isotope == kind.isotope && other.source_model == kind.source_model &&
          other.half_life_days == kind.half_life_days && other.source_length_mm == kind.source_length_mm)
        return known->second = k;
    }
    plan_.more_kinds.push_back(kind);
    return known->second = plan_.more_kinds.size();
  }

  /// The file's statements about a channel; its weights are filled in later.
  static ChannelSays says_of(DcmItem& channel, const std::vector<ControlPoint>& points, const std::string& where) {
    ChannelSays says;
    says.where = where;
    says.total_s = number_of(channel, DCM_ChannelTotalTime).value_or(NAN);
    says.final_weight = number_of(channel, DCM_FinalCumulativeTimeWeight).value_or(0.0);
    says.points = static_cast<int>(points.size());
    says.points_said = integer_of(channel, DCM_NumberOfControlPoints).value_or(0);
    says.pulses = integer_of(channel, DCM_NumberOfPulses).value_or(1);
    says.shielded = !items_of(channel, DCM_ChannelShieldSequence).empty();
    return says;
  }

  /// Directions of dwell positions without orientation: along the line through their neighbours, towards the tip.
  /// @param tip_first whether the channel begins at its tip
  void turn_by_neighbours(std::vector<RestingPlace>& places, bool tip_first) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places[k].axis || places.size() < 2) continue;
      const Vec3 along = places[std::min(k + 1, places.size() - 1)].at_mm - places[k == 0 ? 0 : k - 1].at_mm;
      if (along.norm() < kSameSeed_mm) continue;
      places[k].axis = (tip_first ? -1.0 : 1.0) * along.normalized();
      ++turned_by_channel_;
    }
  }

  /// Whether a channel begins at its tip: its points' distances from the place nearest the tip (300A,02D2) increase, or
  /// it has none.
  static bool begins_at_tip(DcmItem& channel) {
    std::vector<double> distances;
    for (DcmItem* item : items_of(channel, DCM_BrachyControlPointSequence)) {
      if (const auto distance = number_of(*item, DCM_ControlPointRelativePosition)) distances.push_back(*distance);
    }
    return distances.empty() || distances.front() <= distances.back();
  }

  /// Hole of the template, name of the applicator, or the channel's number where it has several places.
  static std::string needle_of(DcmItem& channel, std::size_t places) {
    std::string id = text_of(channel, DCM_SourceApplicatorID);
    if (!id.empty()) return id;
    std::string name = text_of(channel, DCM_SourceApplicatorName);
    if (!name.empty()) return name;
    const auto number = places > 1 ? integer_of(channel, DCM_ChannelNumber) : std::nullopt;
    return number ? std::to_string(*number) : std::string();
  }

  /// @param common what the places have in common
  void add_places(const std::vector<RestingPlace>& places, double seconds_per_weight, const PlannedSource& common) {
    for (const RestingPlace& place : places) {
      PlannedSource source = common;
      source.at_mm = place.at_mm;
      source.axis = place.axis.value_or(Vec3::UnitZ());
      source.has_axis = place.axis.has_value();
      source.dwell_s = place.weight * seconds_per_weight;
      if (plan_.implant == Implant::permanent && is_repeated(source)) continue;
      plan_.sources.push_back(source);
    }
  }

  /// Whether a seed stands in the plan already; a direction that only the repetition has is taken over.
  bool is_repeated(const PlannedSource& seed) {
    const auto found = std::find_if(plan_.sources.begin(), plan_.sources.end(), [&](const PlannedSource& other) {
      return (other.at_mm - seed.at_mm).norm() < kSameSeed_mm;
    });
    if (found == plan_.sources.end()) return false;
    ++repeated_;
    if (std::abs(found->strength_U - seed.strength_U) > 1e-6 * seed.strength_U) ++other_strengths_;
    if (!found->has_axis && seed.has_axis) {
      found->axis = seed.axis;
      found->has_axis = true;
    }
    return true;
  }

  /// The prescription for what the file describes, which of several fractions is one.
  void read_prescription() {
    double of_target = 0.0;
    for (DcmItem* reference : items_of(data_, DCM_DoseReferenceSequence)) {
      const double dose = number_of(*reference, DCM_TargetPrescriptionDose).value_or(0.0);
      if (of_target <= 0.0) of_target = dose;
      if (dose > 0.0) plan_.says.prescriptions.push_back(dose);
    }
    std::set<double> of_setups;
    int fractions = 1;
    for (DcmItem* group : items_of(data_, DCM_FractionGroupSequence)) {
      const auto planned = integer_of(*group, DCM_NumberOfFractionsPlanned);
      fractions = std::max(fractions, planned.value_or(1));
      if (planned) plan_.says.fractions = *planned <= 0 ? -1 : std::max(plan_.says.fractions, *planned);
      for (DcmItem* setup : items_of(*group, DCM_ReferencedBrachyApplicationSetupSequence)) {
        const auto dose = number_of(*setup, DCM_BrachyApplicationSetupDose);
        if (dose && *dose > 0.0) of_setups.insert(*dose);
      }
    }
    const double of_setup = of_setups.size() == 1 ? *of_setups.begin() : 0.0;
    plan_.prescription_Gy = of_target;  // a negative one is refused by the rules for plans
    plan_.says.setup_doses.assign(of_setups.begin(), of_setups.end());
    if (of_target <= 0.0 && of_setup > 0.0) {
      plan_.prescription_Gy = of_setup;
      plan_.notes.push_back(fmt::format(
          "The plan has no target prescription dose (300A,0026); the dose of its setups, {:g} Gy, stands in.",
          of_setup));
    } else if (of_target <= 0.0 && of_setups.size() > 1) {
      plan_.notes.emplace_back(
          "The plan has no target prescription dose (300A,0026), and the doses of its setups (300A,00A4) differ; it is "
          "read without a prescription.");
    }
    if (plan_.implant == Implant::permanent || fractions < 2) return;
    const bool is_sum = of_setup > 0.0 && std::abs(of_target - fractions * of_setup) < 0.01 * of_target;
    if (is_sum) plan_.prescription_Gy = of_setup;
    plan_.notes.push_back(fmt::format("The plan has {} fractions; the dose is that of one{}.", fractions,
                                      is_sum ? fmt::format(", and so is the prescription of {:g} Gy", of_setup) : ""));
  }

  DcmDataset& data_;
  DosePlan plan_;
  std::map<int, PlanSource> sources_;
  int channels_ = 0;
  int repeated_ = 0;
  int other_strengths_ = 0;
  int turned_by_channel_ = 0;
  std::map<int, std::size_t> kinds_;  // of the sources with these numbers
  bool pulsed_ = false;
};

Result<> check_is_plan(DcmDataset& data, const std::string& file) {
  const std::string sop_class = text_of(data, DCM_SOPClassUID);
  const std::string modality = text_of(data, DCM_Modality);
  if (modality == "RTPLAN" || sop_class == UID_RTPlanStorage || sop_class == UID_RTBrachyTreatmentRecordStorage)
    return Ok{};
  return input_error(file, fmt::format("this DICOM file has modality '{}', RTPLAN is expected", modality),
                     "Name the RT Plan; structures go to --structures and doses to --compare");
}

}  // namespace

Result<DosePlan> parse_rtplan(const fs::path& path) {
  const std::string file = path.string();
  DcmFileFormat format;
  const auto check_kind = [&](DcmDataset& data) { return check_is_plan(data, file); };
  if (Result<> loaded = load_dicom(format, path, check_kind, "Name a DICOM RT Plan (modality RTPLAN)"); !loaded)
    return loaded.error();
  return RtplanReader(*format.getDataset(), file).run();
}

}  // namespace stylet::detail

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
  double half_life_days = 0.0, length_mm = 0.0, diameter_mm = 0.0;
};

/// Reads one plan; holds what its parts share.
class RtplanReader {
 public:
  RtplanReader(DcmDataset& data, const std::string& file) : data_(data) { plan_.file = file; }

  Result<DosePlan> run() {
    plan_.label = text_of(data_, DCM_RTPlanLabel);
    plan_.frame_of_reference = text_of(data_, DCM_FrameOfReferenceUID);
    plan_.plan_date = trimmed(text_of(data_, DCM_RTPlanDate) + " " + text_of(data_, DCM_RTPlanTime));
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
      source.half_life_days = number_of(*item, DCM_SourceIsotopeHalfLife).value_or(0.0);
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
    const std::string technique = text_of(data_, DCM_BrachyTreatmentTechnique);
    const std::string type = text_of(data_, DCM_BrachyTreatmentType);
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
    double longest_s = 0.0;
    for (DcmItem* setup : setups) {
      for (DcmItem* channel : items_of(*setup, DCM_ChannelSequence))
        longest_s = std::max(longest_s, number_of(*channel, DCM_ChannelTotalTime).value_or(0.0));
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
      point.weight = number_of(*item, DCM_CumulativeTimeWeight).value_or(0.0);
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
    if (points.empty()) return Ok{};
    const bool seeds = plan_.implant == Implant::permanent;
    Result<std::vector<RestingPlace>> places = resting_places(points, seeds, where);
    if (!places) return places.error();
    if (places->empty()) return Ok{};
    const auto number = source_number(channel, where);
    if (!number) return number.error();
    const PlanSource& source = sources_.at(*number);
    const Result<double> strength = strength_of(source, *number, where);
    if (!strength) return strength.error();
    take_source(source, where);
    double seconds_per_weight = 0.0;
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
      if (std::abs(weights / last - 1.0) > 0.005) {
        plan_.notes.push_back(
            fmt::format("{}: the weights of its places add up to {:g}, the final cumulative time weight is {:g}; the "
                        "channel's time of "
                        "{:g} s is divided by the sum of the weights.",
                        where, weights, last, total_s));
      }
      turn_by_neighbours(*places, begins_at_tip(channel));
    }
    add_places(*places, *strength, seconds_per_weight, needle_of(channel, places->size()));
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

  /// Remembers what the plan says about the source that is used.
  void take_source(const PlanSource& source, const std::string& where) {
    if (plan_.sources.empty()) {
      plan_.isotope = source.isotope;
      // Planning systems leave the model out or have names of their own; this program writes the name that it knows.
      if (find_source(source.model).ok()) plan_.source_model = source.model;
      plan_.half_life_days = source.half_life_days;
      plan_.source_length_mm = source.length_mm;
      plan_.source_diameter_mm = source.diameter_mm;
      plan_.strength_date = source.date;
    } else if (source.isotope != plan_.isotope && !mixed_) {
      mixed_ = true;
      plan_.notes.push_back(fmt::format("{}: the source is {}, earlier ones are {}; all are computed with one model.",
                                        where, source.isotope, plan_.isotope));
    }
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

  void add_places(const std::vector<RestingPlace>& places, double strength, double seconds_per_weight,
                  const std::string& needle) {
    for (const RestingPlace& place : places) {
      PlannedSource source;
      source.at_mm = place.at_mm;
      source.axis = place.axis.value_or(Vec3::UnitZ());
      source.has_axis = place.axis.has_value();
      source.strength_U = strength;
      source.dwell_s = place.weight * seconds_per_weight;
      source.needle = needle;
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
      if (of_target <= 0.0) of_target = number_of(*reference, DCM_TargetPrescriptionDose).value_or(0.0);
    }
    std::set<double> of_setups;
    int fractions = 1;
    for (DcmItem* group : items_of(data_, DCM_FractionGroupSequence)) {
      fractions = std::max(fractions, integer_of(*group, DCM_NumberOfFractionsPlanned).value_or(1));
      for (DcmItem* setup : items_of(*group, DCM_ReferencedBrachyApplicationSetupSequence)) {
        const auto dose = number_of(*setup, DCM_BrachyApplicationSetupDose);
        if (dose && *dose > 0.0) of_setups.insert(*dose);
      }
    }
    const double of_setup = of_setups.size() == 1 ? *of_setups.begin() : 0.0;
    plan_.prescription_Gy = std::max(0.0, of_target);
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
  bool mixed_ = false;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "record/run_columns.hpp"
#include "stylet/implant/recorded_implant.hpp"
#include "stylet/io/implant_record_io.hpp"

/// The fields of the records of an implant, in the order of the columns in files.
namespace stylet {

namespace record {

template <>
inline constexpr bool has_check<SeedAct> = true;
template <>
inline constexpr bool has_check<RecordedScore> = true;

/// The columns with the parts of a seed's error: "bend_mm" or bend_x_mm, bend_y_mm, bend_z_mm.
inline Field field_of(const SeedCauseWords& words) {
  static const std::array names = [] {
    std::array<std::string, kSeedCauses.size()> all;
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = std::string(kSeedCauses[k].column) + "{}_mm";
    return all;
  }();
  const std::string& name = names[static_cast<std::size_t>(words.cause)];
  return Field(name.c_str(), "mm", "part of the error by this cause").since(words.since).in("why").as(words.name);
}

/// The fields of a seed that its own file and the recording of a live session have.
/// @param live only the causes that can occur there
void seed_columns(auto& visit, Of<SeedHistory> auto& s, bool live) {
  visit(Field("number", "", "in the plan, from 1").from_one(), s.number);
  visit(Field("needle", "", "number of its needle, from 0"), s.needle);
  visit(Field("dropped_s", "s", "moment of the drop, since the start of its needle"), s.dropped_s);
  visit(Field("planned{}_mm", "mm", "planned place"), s.planned_mm);
  visit(Field("dropped{}_mm", "mm", "place in the room where it was left"), s.dropped_mm);
  visit(Field("rest{}_mm", "mm", "place in the tissue at rest, with all needles out"), s.rest_mm);
  visit(Field("axis{}", "", "unit vector at rest, towards the tip of its needle"), s.axis);
  for (const SeedCauseWords& words : kSeedCauses)
    if (words.of_drop != nullptr || !live) visit(field_of(words), s.by(words.cause));
  visit(Field("in_tissue", "", "whether the tissue where it was dropped could be found"), s.in_tissue);
  visit(Field("lost", "", "whether it has left the patient"), s.lost);
}

}  // namespace record

void columns(auto& visit, record::Of<SeedHistory> auto& s) {
  using record::Field;
  record::seed_columns(visit, s, false);
  const Vec3 none = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  DwellAtPlanning then = s.at_planning.value_or(DwellAtPlanning{none, none});
  visit(Field("planning_room{}_mm", "mm", "place of a dwell position in the room at planning; NaN for a seed")
            .since(7)
            .unknown_before(),
        then.room_mm);
  visit(Field("planning{}_mm", "mm", "the tissue that was there, by its place at rest").since(7).unknown_before(),
        then.tissue_mm);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(s)>>)
    if (!then.room_mm.hasNaN()) s.at_planning = then;
}

void columns(auto& visit, record::Of<SeedAct> auto& a) {
  using record::Field;
  visit(Field("kind", "", "`earlier`, `dropped`, `taken_back`, `settled`"), a.kind);
  visit(Field("time_s", "s", "simulated time of the recording"), a.time_s);
  record::seed_columns(visit, a.seed, true);
}

void columns(auto& visit, record::Of<RecordedScore> auto& d) {
  using record::Field;
  visit(Field("acts", "", "number of acts before it; −1: it is the dose of the plan"), d.acts);
  visit(Field("seeds", "", "number of seeds that it counts"), d.seeds);
  visit(Field("d90_Gy", "Gy", "dose that 90 % of the target receive"), d.d90_Gy);
  visit(Field("d90_percent", "%", "the same, of the prescribed dose; NaN without one"), d.d90_percent);
  visit(Field("v100_percent", "%", "share of the target that receives the prescribed dose; NaN without one"),
        d.v100_percent);
}

void columns(auto& visit, record::Of<RecordedPlan::Needle> auto& n) {
  using record::Field;
  visit(Field("name", "", "name of the needle").text(64), n.name);
  visit(Field("hole", "", "hole of the template on its line; empty: there is none").text(16), n.hole);
  visit(Field("entry{}_mm", "mm", "skin point on its line, LPS"), n.entry_mm);
  visit(Field("direction{}", "", "unit vector towards the tip, LPS"), n.direction);
  visit(Field("depth_mm", "mm", "base depth at which the tip is at its planned place"), n.depth_mm);
}

void columns(auto& visit, record::Of<RecordedPlan::Seed> auto& s) {
  using record::Field;
  visit(Field("number", "", "in the plan, from 1").from_one(), s.number);
  visit(Field("needle", "", "its row in `needles`, from 0"), s.needle);
  visit(Field("planned{}_mm", "mm", "planned place, LPS"), s.planned_mm);
  visit(Field("axis{}", "", "unit vector towards the tip of its needle"), s.axis);
  visit(Field("drop_depth_mm", "mm", "base depth at which a straight needle pushes it out at its planned place"),
        s.drop_depth_mm);
}

void columns(auto& visit, record::Of<RecordedPlan> auto& p) {
  using record::Field;
  visit(Field("current", "", "number of the recording's needle in `needles`, from 0; −1: a needle beside the plan"),
        p.current);
  visit(Field("seed_length_mm", "mm", "length of a seed"), p.seed_length_mm);
  visit(Field("seed_diameter_mm", "mm", "diameter of a seed"), p.seed_diameter_mm);
  visit(Field("prescription_Gy", "Gy", "prescribed dose; 0: none"), p.prescription_Gy);
  visit(Field("source", "", "name of the source model"), p.source);
  visit(Field("implant", "", "name of the implant: that of the recording of its first needle").since(7), p.implant);
  visit(Field("skin_punctures_before", "", "how often the needles before this one have broken the skin").since(7),
        p.before.skin_punctures);
  visit(Field("organ_entries_before", "", "how often they have entered rectum, bladder or urethra").since(7),
        p.before.organ_entries);
  visit(Field("bone_contacts_before", "", "how often they have met bone").since(7), p.before.bone_contacts);
  visit(Field("exits_before", "", "how often they have come out through the far side").since(7), p.before.exits);
}

void columns(auto& visit, record::Of<NeedleShape> auto& s) {
  using record::Field;
  visit(
      Field("when", "", "`full depth`, `all in place`, or `seed 3 dropped` (the number is that in the plan)").text(64),
      s.when);
  visit(Field("time_s", "s", "simulated time since the first needle with the same `together` went in"), s.time_s);
  visit(Field("base_depth_mm", "mm", "base depth"), s.base_depth_mm);
}

void columns(auto& visit, record::Of<NeedleHistory> auto& n) {
  using record::Field, record::kFile, record::kJson;
  visit(Field("name", "", "name of the needle"), n.name);
  visit(Field("entry{}_mm", "mm", "skin point on its line, LPS"), n.entry_mm);
  visit(Field("direction{}", "", "unit vector, LPS"), n.direction);
  visit(Field("depth_mm", "mm", "largest base depth"), n.depth_mm);
  visit(Field("peak_force_N", "N", "largest axial force on the hand"), n.peak_force_N);
  visit(Field("deflection_mm", "mm", "largest distance of the tip from the straight line"), n.deflection_mm);
  visit(Field("gland_shift{}_mm", "mm", "largest mean shift of the gland"), n.gland_shift_mm);
  visit(Field("step_count", "", "number of steps").as("steps"), n.steps);
  visit(Field("seconds", "s", "processor time of the steps"), n.seconds);
  visit(Field("together", "", "needles with the same number were in the tissue together").only(kFile), n.record.group);
}

void columns(auto& visit, record::Of<RecordedStructure> auto& s) {
  using record::Field;
  visit(Field("name", "", "name in the plan"), s.name);
  visit(Field("region", "", "region that it is taken as"), s.region);
  visit(Field("type", "", "DICOM interpreted type"), s.type);
  visit(Field("colour", "", "red, green, blue"), s.colour);
  visit(Field("volume_cc", "cc", "volume"), s.volume_cc);
}

void columns(auto& visit, record::Of<RecordedDose> auto& d) {
  using record::Field;
  visit(Field("origin{}_mm", "mm", "place of its first point, LPS"), d.grid.origin_mm);
  visit(Field("spacing{}_mm", "mm", "distance of its points along x, y, z"), d.grid.spacing_mm);
}

void columns(auto& visit, record::Of<ImplantRecord> auto& r) {
  using record::Field;
  visit(Field("version", "", "version of the program"), r.version);
  visit(Field("scenario_name", "", "name of the scenario"), r.scenario_name);
  visit(Field("source", "", "name of the source model"), r.source);
  visit(Field("prescription_Gy", "Gy", "prescribed dose"), r.prescription_Gy);
  visit(Field("needle_diameter_mm", "mm", "diameter of the needles"), r.needle_diameter_mm);
  visit(Field("needle_length_mm", "mm", "length of the needles"), r.needle_length_mm);
  visit(Field("seed_length_mm", "mm", "length of a seed"), r.seed_length_mm);
  visit(Field("implant", "", "`permanent` or `temporary`").since(7), r.implant);
}

namespace results {

/// A seed, or a dwell position, in seeds.csv and in summary.json.
struct SeedRow {
  SeedHistory seed;
  std::string needle;  ///< name of its needle or catheter
  Implant implant = Implant::permanent;
  double dwell_s = 0.0;  ///< of the plan
};

/// A seed in found.csv and in summary.json: a seed of the implant, where it was found, or both.
struct FoundRow {
  std::optional<std::size_t> number;  ///< in the plan; empty: a found seed without a match
  std::optional<std::string> needle;
  std::optional<std::size_t> found;  ///< in the file; empty: it was not found
  std::optional<bool> ambiguous;
  std::optional<Vec3> planned_mm, dropped_mm, rest_mm, found_mm, error_mm;
  std::optional<SeedCauseParts> causes;  ///< empty for a lost seed and without a match
  std::optional<Vec3> remainder_mm, remainder_without_shift_mm;
};

void columns(auto& visit, record::Of<SeedRow> auto& shown) {
  using record::Field, record::kCsv, record::kJson;
  auto& s = shown.seed;
  const bool dwell = shown.implant == Implant::temporary;
  visit(Field(dwell ? "dwell_position" : "seed", "", "in the plan, from 1").from_one().as("number"), s.number);
  visit(Field(dwell ? "catheter" : "needle", "", "its name"), shown.needle);
  if (dwell) visit(Field("dwell_s", "s", "dwell time of the plan").only(kJson), shown.dwell_s);
  visit(Field("planned{}_mm", "mm", "planned place"), s.planned_mm);
  if (dwell) {
    const DwellAtPlanning then = s.at_planning.value_or(DwellAtPlanning{});
    visit(Field("planning_room{}_mm", "mm", "place in the room at planning"), then.room_mm);
    visit(Field("planning{}_mm", "mm", "the tissue that is there, by its place at rest"), then.tissue_mm);
  }
  visit(dwell ? Field("delivery_room{}_mm", "mm", "place in the room at delivery")
              : Field("dropped{}_mm", "mm", "place in the room where it was left"),
        s.dropped_mm);
  visit(dwell ? Field("delivery{}_mm", "mm", "the tissue that is there, by its place at rest")
              : Field("rest{}_mm", "mm", "place at rest, with all needles out"),
        s.rest_mm);
  visit(Field("axis{}", "", "unit vector at rest").only(kJson), s.axis);
  const std::array axes{"ax", "ay", "az"};
  for (std::size_t k = 0; k < 3; ++k)
    visit(Field(axes[k], "", "unit vector at rest").only(kCsv), s.axis[static_cast<Eigen::Index>(k)]);
  if (dwell) visit(Field("dwell_s", "s", "dwell time of the plan").only(kCsv), shown.dwell_s);
  const Vec3 error = s.error_mm();
  const double distance = error.norm();
  visit(Field("error_mm", "mm", "distance from the planned place"), distance);
  visit(Field("error_xyz_mm", "mm", "place at rest less the planned place").only(kJson), error);
  if (!dwell) {
    visit(Field("dropped_s", "s", "moment of the drop, since the start of its needle").only(kJson), s.dropped_s);
    visit(Field("lost", "", "whether it has left the patient"), s.lost);
  }
  visit(Field("in_tissue", "", "whether its tissue point could be found"), s.in_tissue);
  for (const SeedCauseWords& words : kSeedCauses)
    if (meaning_of(words.cause, shown.implant) != nullptr) visit(record::field_of(words), s.by(words.cause));
}

void columns(auto& visit, record::Of<FoundRow> auto& f) {
  using record::Field, record::kCsv, record::kJson;
  visit(Field("seed", "", "in the plan, from 1").from_one().as("number"), f.number);
  visit(Field("needle", "", "name of its needle"), f.needle);
  visit(Field("found", "", "number in the file, from 1").from_one().as("found_number"), f.found);
  visit(Field("ambiguous", "", "whether the match is ambiguous").only(kCsv), f.ambiguous);
  visit(Field("planned{}_mm", "mm", "planned place"), f.planned_mm);
  visit(Field("dropped{}_mm", "mm", "place in the room where it was left"), f.dropped_mm);
  visit(Field("rest{}_mm", "mm", "simulated place at rest"), f.rest_mm);
  visit(Field("found{}_mm", "mm", "place where it was found"), f.found_mm);
  std::optional<double> distance;
  if (f.error_mm) distance = f.error_mm->norm();
  visit(Field("error_mm", "mm", "distance of found and planned place").only(kJson), distance);
  visit(Field("error{}_mm", "mm", "found place less planned place").as("error_xyz_mm"), f.error_mm);
  for (const SeedCauseWords& words : kSeedCauses) {
    if (words.of_seed == nullptr) continue;
    std::optional<Vec3> part;
    if (f.causes) part = (*f.causes)[static_cast<std::size_t>(words.cause)];
    visit(record::field_of(words), part);
  }
  visit(Field("remainder{}_mm", "mm", "found place less simulated place").as("remainder_xyz_mm"), f.remainder_mm);
  visit(Field("remainder_without_shift{}_mm", "mm", "the same without the common shift")
            .as("remainder_without_shift_xyz_mm"),
        f.remainder_without_shift_mm);
  visit(Field("ambiguous", "", "whether the match is ambiguous").only(kJson), f.ambiguous);
}

}  // namespace results
}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the texts of forces.csv, gland.csv, map.csv and summary.json.
#include "record/csv.hpp"
#include "record/run_columns.hpp"
#include "results/summary_json.hpp"
#include "stylet/io/hole_map_io.hpp"
#include "support/value_of.hpp"
#include "synthetic_run.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <sstream>

using namespace stylet;
using namespace stylet::results;
using namespace stylet::testing;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> keys_of(const nlohmann::ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

}  // namespace

/// Programs that read it may count on the places of these columns. New ones come behind them.
TEST(ForcesCsv, begins_with_the_columns_that_it_always_had) {
  EXPECT_TRUE(record::csv_of(std::vector<Step>{})
                  .starts_with("time_s,base_depth_mm,force_axial_N,force_sagittal_N,force_lateral_N,torque_x_Nmm,"
                               "torque_y_Nmm,torque_z_Nmm,tip_x_mm,tip_y_mm,tip_z_mm,tip_state,contacts,sticking,"
                               "iterations,step_us"));
}

TEST(ForcesCsv, one_line_per_step_with_fixed_digits) {
  Step step;
  step.time_s = 1.0005;
  step.base_depth_mm = -2.5;
  step.force_axial_N = 1.0 / 3;
  step.force_sagittal_N = -1e-12;  // rounds to zero, which is printed without a sign
  step.force_lateral_N = -0.25;
  step.torque_Nmm = {1, -2, 3.5};
  step.tip_mm = {10, 20.125, -30};
  step.tip_state = TipState::in_track;
  step.contacts = 7;
  step.sticking = 3;
  step.iterations = 2;
  step.step_us = 412.34;
  const auto lines = lines_of(record::csv_of(std::span<const Step>(&step, 1)));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(
      lines[1].starts_with("1.000500,-2.500000,0.333333333,0.000000000,-0.250000000,1.000000000,-2.000000000,"
                           "3.500000000,10.000000,20.125000,-30.000000,in_track,7,3,2,412.3"))
      << lines[1];
}

TEST(ForcesCsv, the_same_run_gives_the_same_bytes_apart_from_step_us) {
  auto one = synthetic_run(), other = synthetic_run();
  EXPECT_EQ(record::csv_of(one.steps), record::csv_of(other.steps));
  for (auto& step : other.steps) step.step_us += 17;
  EXPECT_NE(record::csv_of(one.steps), record::csv_of(other.steps));
  for (auto* run : {&one, &other})
    for (auto& step : run->steps) step.step_us = 0;
  EXPECT_EQ(record::csv_of(one.steps), record::csv_of(other.steps));
}

TEST(GlandCsv, has_the_documented_columns_in_patient_directions_and_planes) {
  const GlandStep step{1.0005, -2.5, {0.25, -0.5, 1.0 / 3}, {1.0, 2.0, -1e-9}};  // about LR, AP and SI
  const auto lines = lines_of(record::csv_of(std::span<const GlandStep>(&step, 1)));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0],
            "time_s,base_depth_mm,shift_LR_mm,shift_AP_mm,shift_SI_mm,rotation_coronal_deg,rotation_sagittal_deg,"
            "rotation_transverse_deg");
  EXPECT_EQ(lines[1], "1.000500,-2.500000,0.250000,-0.500000,0.333333,2.000000,1.000000,0.000000");
}

TEST(SummaryJson, tells_how_the_gland_moved_in_patient_directions) {
  const auto run = synthetic_run();
  const auto json = nlohmann::ordered_json::parse(summary_json(run.summary));
  using Keys = std::vector<std::string>;
  const auto& gland = json["gland"];
  EXPECT_EQ(keys_of(gland), (Keys{"shift_at_break_mm", "shift_max_mm", "shift_in_place_mm", "shift_residual_mm",
                                  "rotation_deg", "base_mm", "mid_mm", "apex_mm", "volume_change_percent"}));
  for (const char* shift :
       {"shift_at_break_mm", "shift_max_mm", "shift_in_place_mm", "shift_residual_mm", "base_mm", "mid_mm", "apex_mm"})
    EXPECT_EQ(keys_of(gland[shift]), (Keys{"LR", "AP", "SI", "norm"})) << shift;
  EXPECT_EQ(gland["shift_max_mm"]["LR"], 0.22);
  EXPECT_EQ(gland["shift_max_mm"]["AP"], -0.5);
  EXPECT_EQ(gland["shift_max_mm"]["SI"], 2.71);
  EXPECT_EQ(gland["shift_max_mm"]["norm"], run.summary.gland->shift_max_mm.norm());
  EXPECT_EQ(keys_of(gland["rotation_deg"]), (Keys{"coronal", "sagittal", "transverse"}));
  EXPECT_EQ(gland["rotation_deg"]["coronal"], -0.5) << "about AP";
  EXPECT_EQ(gland["rotation_deg"]["sagittal"], 1.25) << "about LR";
  EXPECT_EQ(gland["rotation_deg"]["transverse"], 0.25) << "about SI";
}

TEST(SummaryJson, of_the_gland_survives_the_round_trip_with_what_is_missing) {
  Summary summary;
  summary.gland.emplace();
  summary.gland->shift_max_mm = {1, 2, 3};
  summary.gland->rotation_deg = {4, 5, 6};
  summary.gland->mid_mm.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto json = nlohmann::json::parse(summary_json(summary));
  EXPECT_TRUE(json["gland"]["shift_at_break_mm"].is_null());
  EXPECT_TRUE(json["gland"]["shift_residual_mm"].is_null());
  EXPECT_TRUE(json["gland"]["mid_mm"].is_null());
  const auto back = test::value_of(parse_summary_json(summary_json(summary), "test"));
  ASSERT_TRUE(back.gland);
  EXPECT_EQ(back.gland->shift_max_mm, Vec3(1, 2, 3));
  EXPECT_EQ(back.gland->rotation_deg, Vec3(4, 5, 6));
  EXPECT_FALSE(back.gland->shift_residual_mm);
  EXPECT_EQ(summary_json(back), summary_json(summary));
  EXPECT_TRUE(nlohmann::json::parse(summary_json({}))["gland"].is_null()) << "no target";
  auto older = json;
  older.erase("gland");
  older.erase("tip_error_mm");
  EXPECT_TRUE(parse_summary_json(older.dump(), "test").ok());
}

TEST(MapCsv, has_a_line_for_each_hole_and_nothing_where_there_is_no_figure) {
  const HoleMap map = synthetic_map();
  std::istringstream lines(hole_map_csv(map));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "hole,left_mm,anterior_mm,depth_mm,in_target_mm,clearance_bone_mm,clearance_urethra_mm,clearance_rectum_mm,"
            "shift_at_break_mm,shift_max_mm,tip_error_mm,remark");
  std::size_t count = 0;
  while (std::getline(lines, line)) {
    const HoleRow& row = map.holes[count++];
    EXPECT_TRUE(line.starts_with(row.hole + ",")) << line;
    if (row.hole == "D1") {
      EXPECT_TRUE(line.ends_with(R"(,,,,,,,"the target's far end lies 210 mm deep, the needle is 200 mm long")"))
          << line;
    }
    if (row.hole == "D4") {
      EXPECT_TRUE(line.ends_with(R"(,"The needle entered the urethra, at a depth of 27.0 mm.")")) << line;
    }
    if (row.hole == "D7") {
      EXPECT_TRUE(line.ends_with(R"(,,,,,"")")) << line;
    }
  }
  EXPECT_EQ(count, map.holes.size());
}

TEST(MapCsv, with_needles_in_place_has_the_figures_from_the_tissue_as_they_hold_it_as_well) {
  const HoleMap map = synthetic_map_beside_needles();
  std::istringstream lines(hole_map_csv(map));
  std::string line;
  std::getline(lines, line);
  EXPECT_TRUE(
      line.ends_with("shift_at_break_mm,shift_max_mm,tip_error_mm,in_place_shift_at_break_mm,"
                     "in_place_shift_max_mm,in_place_tip_error_mm,remark"))
      << line;
  for (const HoleRow& row : map.holes) {
    ASSERT_TRUE(std::getline(lines, line));
    if (!row.prediction || line.find('"') != line.rfind('"') - 1) continue;  // a remark may contain commas
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 15U) << line;
    EXPECT_NEAR(std::stod(fields[12]), row.prediction->in_place->shift_max_mm->norm(), 1e-6) << line;
    EXPECT_NEAR(std::stod(fields[13]), row.prediction->in_place->tip_error_mm->norm(), 1e-6) << line;
  }
}

TEST(MapJson, says_which_needles_are_in_place_and_what_counts_from_there) {
  const auto alone = nlohmann::json::parse(hole_map_json(synthetic_map()));
  EXPECT_TRUE(alone.at("in_place").empty());
  for (const auto& hole : alone.at("holes")) EXPECT_FALSE(hole.contains("in_place"));
  const auto beside = nlohmann::json::parse(hole_map_json(synthetic_map_beside_needles()));
  EXPECT_EQ(beside.at("in_place"), (nlohmann::json{"B4", "F4"}));
  for (const auto& hole : beside.at("holes")) {
    ASSERT_EQ(hole.contains("in_place"), hole.at("predicted").get<bool>());
    if (!hole.contains("in_place")) continue;
    EXPECT_EQ(hole.at("in_place").at("shift_mm").at("SI"), 2.0);
    EXPECT_LT(hole.at("in_place").at("shift_max_mm").at("norm"), hole.at("shift_max_mm").at("norm"));
  }
}

TEST(SummaryJson, has_the_documented_keys_in_order) {
  const auto run = synthetic_run();
  const auto json = nlohmann::ordered_json::parse(summary_json(run.summary));
  using Keys = std::vector<std::string>;
  EXPECT_EQ(keys_of(json), (Keys{"version", "scenario", "mesh", "steps", "peak_force_N", "events", "tip_deflection_mm",
                                 "tip_error_mm", "target_shift_mm", "gland", "residual", "step_us", "contacts_max",
                                 "capacity", "compliance_condition", "mesh_blur_mm", "mesh_changes", "warnings"}));
  EXPECT_EQ(keys_of(json["mesh"]), (Keys{"nodes", "tets"}));
  EXPECT_EQ(keys_of(json["peak_force_N"]), (Keys{"axial", "sagittal", "lateral"}));
  EXPECT_EQ(keys_of(json["target_shift_mm"]), (Keys{"centroid", "max"}));
  EXPECT_EQ(keys_of(json["residual"]), (Keys{"force_balance", "torque_balance"}));
  EXPECT_EQ(keys_of(json["step_us"]), (Keys{"p50", "p99", "p999", "max"}));
  ASSERT_EQ(json["events"].size(), run.summary.events.size());
  EXPECT_EQ(keys_of(json["events"][0]), (Keys{"kind", "time_s", "depth_mm", "force_N", "region"}));
  EXPECT_EQ(json["events"][0]["kind"], "skin_contact");
  EXPECT_EQ(json["target_shift_mm"]["centroid"].size(), 3U);
  EXPECT_EQ(json["peak_force_N"]["axial"].get<double>(), run.summary.peak_axial_N);
}

TEST(SummaryJson, changes_of_the_mesh_survive_the_round_trip) {
  Summary summary;
  summary.mesh_changes.push_back({0.5,
                                  12.0,
                                  {.kind = RemeshEvent::Kind::repositioned,
                                   .node = 17,
                                   .dimension = 45,
                                   .elements = 22,
                                   .moved_mm = 2.5,
                                   .condition = 41.0}});
  summary.mesh_changes.push_back({0.7,
                                  14.0,
                                  {.kind = RemeshEvent::Kind::added_on_face,
                                   .refused = RemeshEvent::Refused::boundary,
                                   .node = 600,
                                   .dimension = 18,
                                   .elements = 6}});
  const auto json = nlohmann::ordered_json::parse(summary_json(summary));
  EXPECT_EQ(json["mesh_changes"][1]["not_moved_because"], "boundary");
  EXPECT_TRUE(json["mesh_changes"][1]["condition"].is_null());
  EXPECT_EQ(summary_json(parse_summary_json(summary_json(summary), "test").value()), summary_json(summary));
}

TEST(SummaryJson, a_value_that_is_not_finite_becomes_null) {
  Summary summary;
  summary.target_shift_max_mm = std::numeric_limits<double>::quiet_NaN();
  summary.target_shifts.push_back({summary.target_shift_centroid_mm, summary.target_shift_max_mm});
  const auto json = nlohmann::json::parse(summary_json(summary));
  EXPECT_TRUE(json["target_shift_mm"]["max"].is_null());
  const auto back = test::value_of(parse_summary_json(summary_json(summary), "test"));
  EXPECT_TRUE(std::isnan(back.target_shift_max_mm));
}

TEST(SummaryJson, without_a_target_nothing_has_moved_it) {
  const Summary summary;
  EXPECT_TRUE(nlohmann::json::parse(summary_json(summary))["target_shift_mm"].is_null());
  EXPECT_TRUE(parse_summary_json(summary_json(summary), "test")->target_shifts.empty());
}

TEST(SummaryJson, one_of_before_there_were_capacities_is_read) {
  Summary summary;
  summary.contacts_max = 7;
  auto json = nlohmann::json::parse(summary_json(summary));
  json.erase("capacity");
  const auto back = test::value_of(parse_summary_json(json.dump(), "test"));
  EXPECT_EQ(back.capacity.contacts.room, 0);
  EXPECT_EQ(back.contacts_max, 7);
}

TEST(SummaryJson, foreign_json_is_refused_with_its_place) {
  const auto bad = parse_summary_json("{\"version\": \"1\"}", "run.h5");
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().where, "run.h5");
}

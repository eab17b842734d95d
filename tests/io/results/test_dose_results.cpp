// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the result folder of a dose computation: JSON, table, page, and errors of writing.
#include "report_page.hpp"
#include "results/dose/dose_view.hpp"
#include "results/dose/structure_look.hpp"
#include "results/dose/structure_mask.hpp"
#include "stylet/io/dose_results.hpp"
#include "support/folder.hpp"
#include "synthetic_dose.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::testing;
namespace fs = std::filesystem;

namespace {

/// The implant with coarse samples, which is computed once.
const DoseEvaluation& implant() {
  static const DoseEvaluation evaluation = synthetic_dose(4.0, 1.5);
  return evaluation;
}

std::vector<std::string> keys_of(const nlohmann::ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

/// Volume [mm³] within a closed surface whose triangles go round counter-clockwise, seen from outside.
double enclosed(const results::StructureSurface& surface) {
  const auto point = [&](std::uint32_t p) {
    return Vec3(surface.points_mm[3 * p], surface.points_mm[3 * p + 1], surface.points_mm[3 * p + 2]);
  };
  double volume = 0.0;
  for (std::size_t t = 0; t < surface.triangles.size(); t += 3) {
    volume +=
        point(surface.triangles[t]).dot(point(surface.triangles[t + 1]).cross(point(surface.triangles[t + 2]))) / 6;
  }
  return volume;
}

}  // namespace

TEST(DoseJson, has_the_documented_keys_in_their_order) {
  const auto json = nlohmann::ordered_json::parse(dose_json(implant()));
  EXPECT_EQ(keys_of(json),
            (std::vector<std::string>{"seeds",    "source",  "sources",   "formalism",   "prescription_Gy",
                                      "quantity", "implant", "patient",   "strength",    "computed_on",
                                      "program",  "inputs",  "dvh",       "left_out",    "goals",
                                      "points",   "compare", "seed_list", "assumptions", "warnings"}));
  EXPECT_EQ(keys_of(json["dvh"][0]),
            (std::vector<std::string>{"structure", "region", "type", "volume_cc", "D90_Gy", "D30_Gy", "D10_Gy", "D5_Gy",
                                      "D2cc_Gy", "D1cc_Gy", "D01cc_Gy", "V100_percent", "V150_percent", "V200_percent",
                                      "V100_cc", "mean_Gy", "covered_by_grid_percent"}));
  EXPECT_EQ(keys_of(json["goals"][0]),
            (std::vector<std::string>{"structure", "metric", "bound", "value", "met", "citation"}));
  EXPECT_EQ(keys_of(json["points"][0]), (std::vector<std::string>{"x_mm", "y_mm", "z_mm", "dose_Gy"}));
  EXPECT_EQ(keys_of(json["compare"]),
            (std::vector<std::string>{"median_ratio", "p1", "p99", "points", "file", "gamma"}));
  EXPECT_EQ(keys_of(json["seed_list"][0]),
            (std::vector<std::string>{"position_mm", "axis", "strength_U", "needle", "dwell_s"}));
}

TEST(DoseJson, has_the_figures_of_the_histograms) {
  const DoseEvaluation& e = implant();
  const auto json = nlohmann::json::parse(dose_json(e));
  EXPECT_EQ(json["seeds"], 44);
  EXPECT_EQ(json["source"], "i125_6711");
  EXPECT_EQ(json["formalism"], "line2d");
  EXPECT_EQ(json["prescription_Gy"], 145.0);
  EXPECT_EQ(json["implant"], "permanent");
  ASSERT_EQ(json["dvh"].size(), 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const DoseVolume& dvh = e.structures[k].dvh;
    const auto& row = json["dvh"][k];
    EXPECT_EQ(row["structure"], e.structures[k].name);
    EXPECT_EQ(row["D90_Gy"], dvh.dose_of_percent(90));
    EXPECT_EQ(row["D5_Gy"], dvh.dose_of_percent(5));
    EXPECT_EQ(row["D01cc_Gy"], dvh.dose_of_volume(0.1));
    EXPECT_EQ(row["V150_percent"], dvh.percent_above(1.5 * 145.0));
    EXPECT_EQ(row["V100_cc"], dvh.volume_above_cc(145.0));
  }
  EXPECT_EQ(json["seed_list"][0]["position_mm"].size(), 3);
  EXPECT_EQ(json["points"][1]["z_mm"], 45.0);
}

TEST(DoseJson, says_null_where_nothing_can_be_said) {
  DoseEvaluation e = implant();
  e.prescription_Gy = 0.0;
  e.comparison.reset();
  const auto json = nlohmann::json::parse(dose_json(e));
  EXPECT_TRUE(json["prescription_Gy"].is_null());
  EXPECT_TRUE(json["compare"].is_null());
  for (const char* key : {"V100_percent", "V150_percent", "V200_percent", "V100_cc"})
    EXPECT_TRUE(json["dvh"][0][key].is_null()) << key;
  EXPECT_TRUE(json["dvh"][0]["D90_Gy"].is_number());
  const auto& bladder = json["goals"].back();
  EXPECT_TRUE(bladder["value"].is_null());
  EXPECT_TRUE(bladder["met"].is_null()) << "a goal of a structure that the plan lacks is neither met nor missed";
  EXPECT_EQ(json["goals"][0]["bound"], ">= 100");
  EXPECT_EQ(bladder["bound"], "<= 100");
}

TEST(DvhCsv, has_a_column_for_each_structure_with_its_name_in_quotation_marks) {
  DoseEvaluation e = implant();
  e.structures[1].name = "Urethra, \"proximal\"";
  std::istringstream csv(dvh_csv(e));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "dose_Gy,\"Prostate\",\"Urethra, \"\"proximal\"\"\",\"Rectum\"");
  std::getline(csv, line);
  EXPECT_EQ(line, "0.000,100.000,100.000,100.000");
  double before = 100.0, dose = 0.0;
  int rows = 1;
  while (std::getline(csv, line)) {
    ++rows;
    double step = 0.0, target = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf", &step, &target), 2) << line;
    EXPECT_NEAR(step - dose, 1.45, 0.0011) << "one per cent of the prescribed dose";
    EXPECT_LE(target, before);
    EXPECT_NEAR(target, e.structures[0].dvh.percent_above(step), 0.5);
    before = target;
    dose = step;
  }
  EXPECT_LE(rows, 401);
  EXPECT_GT(dose, 145.0);
}

TEST(DvhCsv, ends_at_the_first_dose_that_nothing_receives) {
  DoseEvaluation e = implant();
  e.structures.erase(e.structures.begin(), e.structures.begin() + 2);  // the rectum is left
  const double hottest = e.structures[0].dvh.dose_of_percent(0.0);
  const std::string csv = dvh_csv(e);
  const auto rows = static_cast<double>(count(csv, "\n") - 1);
  EXPECT_NEAR(rows, std::floor(hottest / 1.45) + 2, 1.0);
  EXPECT_TRUE(csv.ends_with(",0.000\n"));
}

TEST(DoseFolder, holds_all_files_and_nothing_else) {
  const Folder folder;
  const auto done = write_dose_results(implant(), folder.path());
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(names_in(folder.path()),
            (std::vector<std::string>{"dose.dcm", "dose.json", "dose.nrrd", "dvh.csv", "plan.dcm", "report.html"}));
  EXPECT_EQ(content_of(folder / "dose.json"), dose_json(implant()));
  EXPECT_EQ(content_of(folder / "dvh.csv"), dvh_csv(implant()));
  EXPECT_TRUE(content_of(folder / "dose.nrrd").starts_with("NRRD"));
}

TEST(DoseFolder, leaves_nothing_where_it_cannot_be_written) {
  const Folder folder;
  std::ofstream(folder / "file") << "a file";
  const auto done = write_dose_results(implant(), folder / "file" / "results");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::input);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"file"});
  EXPECT_EQ(content_of(folder / "file"), "a file");
}

TEST(DoseFolder, has_no_dose_json_after_a_failure) {
  const Folder folder;
  fs::create_directories(folder / "dvh.csv" / "inside");  // a file cannot take the place of a folder
  std::ofstream(folder / "dose.json") << "of an earlier run";
  const auto done = write_dose_results(implant(), folder.path());
  ASSERT_FALSE(done);
  EXPECT_FALSE(fs::exists(folder / "dose.json"));
  for (const std::string& name : names_in(folder.path())) EXPECT_FALSE(name.starts_with(".")) << name;
}

TEST(DosePage, escapes_names_and_sentences) {
  DoseEvaluation e = implant();
  const std::string name = "<b>PTV & \"x\"";
  e.structures[0].name = name;
  e.plan.label = name;
  e.plan.sources[0].needle = name;
  e.warnings = {name};
  e.assumptions = {name};
  e.plan.notes = {name};
  e.goals[0].goal.citation = name;
  e.comparison->file = name;
  const Folder folder;
  const auto done = write_dose_results(e, folder.path());
  ASSERT_TRUE(done) << done.error().message();
  const std::string page = content_of(folder / "report.html");
  EXPECT_EQ(count(page, "<b>PTV"), 0);
  EXPECT_GE(count(markup(page), "&lt;b&gt;PTV &amp; &quot;x&quot;"), 8);
  const auto data = nlohmann::json::parse(between(page, "id=\"dose-data\">", "</script>"));
  EXPECT_EQ(data["structures"][0]["name"], name);
}

TEST(DosePage, says_of_each_goal_whether_it_is_met_in_words) {
  const Folder folder;
  ASSERT_TRUE(write_dose_results(implant(), folder.path()));
  const std::string table = between(content_of(folder / "report.html"), "<table class=\"goals\">", "</table>");
  std::size_t met = 0, missed = 0;
  for (const JudgedGoal& goal : implant().goals) {
    if (goal.value) ++(goal.met ? met : missed);
  }
  EXPECT_EQ(count(table, "</i>met<"), met);
  EXPECT_EQ(count(table, "</i>missed<"), missed);
  EXPECT_EQ(count(table, "</i>not judged<"), 1);
}

TEST(DosePage, stays_below_8_MB_with_a_large_grid_and_many_structures) {
  DoseEvaluation e = implant();
  e.grid.size = {200, 200, 200};
  e.grid.spacing_mm = Vec3::Constant(0.44);
  e.grid.dose_Gy.assign(200UL * 200UL * 200UL, 100.0F);
  while (e.structures.size() < 24) e.structures.push_back(e.structures[e.structures.size() % 3]);
  const Folder folder;
  const auto done = write_dose_results(e, folder.path());
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_LT(fs::file_size(folder / "report.html"), 8U << 20U);
}

TEST(DosePage, shows_a_plan_of_one_seed_without_anything_else) {
  DoseEvaluation e = implant();
  e.plan.sources.resize(1);
  e.structures.clear();
  e.goals.clear();
  e.points.clear();
  e.comparison.reset();
  e.prescription_Gy = 0.0;
  const Folder folder;
  const auto done = write_dose_results(e, folder.path());
  ASSERT_TRUE(done) << done.error().message();
  const std::string page = content_of(folder / "report.html");
  EXPECT_EQ(count(page, "No structures were given."),
            1 + count(between(page, "<script>", "</script>"), "No structures were given."));
  EXPECT_EQ(count(markup(page), "{{"), 0);
  EXPECT_EQ(content_of(folder / "dvh.csv"), "dose_Gy\n0.000\n");
  const auto data = nlohmann::json::parse(between(page, "id=\"dose-data\">", "</script>"));
  EXPECT_EQ(data["centre_mm"][2], e.plan.sources[0].at_mm.z()) << "without a target the view is about the sources";
  EXPECT_GT(data["dose"]["values"].get<std::string>().size(), 100U);
}

TEST(StructureMask, is_half_full_at_a_surface_with_the_volume_of_the_samples) {
  for (const StructureDose& structure : implant().structures) {
    const auto mask = results::structure_mask(structure, 2e5);
    ASSERT_TRUE(mask);
    const results::StructureSurface surface = results::mask_surface(*mask, 1e4);
    EXPECT_LE(surface.triangles.size() / 3, 10500U);
    EXPECT_NEAR(enclosed(surface) / 1000.0 / structure.dvh.volume_cc(), 1.0, 0.02) << structure.name;
  }
}

TEST(StructureColours, differ_and_are_dark_enough_for_a_white_page) {
  DoseEvaluation e = implant();
  e.structures[0].colour = {255, 255, 0};
  e.structures[1].colour = {255, 255, 0};
  e.structures[2].colour = {255, 255, 255};
  const auto colours = results::structure_colours(e.structures);
  EXPECT_EQ(std::set<std::string>(colours.begin(), colours.end()).size(), 3U);
  for (const std::string& colour : colours) EXPECT_LT(colour, "#f0") << "a line on white";
}

TEST(IsodoseLevels, are_shares_of_the_prescription_or_round_doses) {
  DoseEvaluation e = implant();
  const auto prescribed = results::isodose_levels(e);
  ASSERT_EQ(prescribed.size(), 4U);
  EXPECT_EQ(prescribed[0].label, "50 %");
  EXPECT_TRUE(prescribed[1].main);
  EXPECT_EQ(prescribed[3].dose_Gy, 290.0);
  e.prescription_Gy = 0.0;
  const auto round = results::isodose_levels(e);
  ASSERT_EQ(round.size(), 4U);
  EXPECT_EQ(round[1].label, "100 Gy") << "round, below the median dose of the target";
  EXPECT_FALSE(round[1].main);
}

TEST(ViewedDose, agrees_with_the_grid_and_stops_at_its_ceiling) {
  const DoseEvaluation& e = implant();
  const auto view = results::dose_view(e);
  EXPECT_LT((view.centre_mm - Vec3(2, -30, 15)).norm(), 0.1) << "the target's centre";
  const auto dose = results::viewed_dose(e.grid, view, 300.0, 7e5);
  ASSERT_EQ(dose.value.size(), static_cast<std::size_t>(dose.size[0]) * static_cast<std::size_t>(dose.size[1]) *
                                   static_cast<std::size_t>(dose.size[2]));
  double largest = 0.0;
  for (std::size_t p = 0; p < dose.value.size(); ++p) {
    const auto nx = static_cast<std::size_t>(dose.size[0]), ny = static_cast<std::size_t>(dose.size[1]);
    const Vec3 at =
        dose.origin_mm + dose.spacing_mm * Vec3(static_cast<double>(p % nx), static_cast<double>(p / nx % ny),
                                                static_cast<double>(p / (nx * ny)));
    const double given = dose.scale_Gy * dose.value[p];
    ASSERT_NEAR(given, std::min(300.0, e.grid.at(at)), 0.005) << at.transpose();
    largest = std::max(largest, given);
  }
  EXPECT_NEAR(largest, 300.0, 1e-9);
}

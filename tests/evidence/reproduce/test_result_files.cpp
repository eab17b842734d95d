// SPDX-License-Identifier: GPL-3.0-or-later
// The files of an invented reproduction: their names and keys, and that they appear complete or not at all.
#include "stylet/evidence/reproduce/reproduction.hpp"
#include "support/folder.hpp"
#include "support/says.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <utility>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::reproduce;
namespace fs = std::filesystem;

namespace {

Figure6Run made_up_run(const Figure6Variant& variant) {
  Figure6Run run;
  run.variant = variant;
  for (int i = 0; i < 6; ++i) {
    Step step;
    step.time_s = 0.001 * (i + 1);
    step.force_axial_N = 0.1 * i;
    step.base_depth_mm = i < 3 ? 1.0 * i : 4.5 - i;
    step.step_us = i == 2 ? 5000.0 : 100.0;
    run.steps.push_back(step);
    run.insertion.push_back(0);
    run.remeshings.push_back(i == 2 ? 1 : 0);
  }
  Event punctured{.kind = EventKind::puncture, .time_s = 0.003, .depth_mm = 1.0, .force_N = 0.5, .region = "prostate"};
  run.events.push_back({2, 0, punctured});
  run.remeshes.push_back({2, 0, {.kind = RemeshEvent::Kind::added_on_face, .dimension = 18, .elements = 6}});
  return run;
}

Reproduction made_up() {
  Reproduction r;
  r.options.command = "stylet reproduce -o out <&>";
  r.version = "0";
  r.machine.processor = "a processor";
  r.machine.blas_threads = 1;
  r.figure2.organ = "prostate";
  r.figure2.contours.push_back({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {true, true, true, false}});
  r.figure2.surface_points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  r.figure2.surface_triangles = {{0, 1, 2}};
  r.figure5 = {{52, 10, 4e-5, 3e-5, 2e-5, 1e-5, 1e-13, 3, 2, 3e4, 2e4},
               {98, 10, 4e-4, 3e-4, 2e-4, 1e-4, 1e-13, 5, 2, 9e4, 5e4}};
  r.figure6.nodes = 570;
  r.figure6.repeats = 1;
  r.figure6.insertions = {"a needle"};
  for (const Figure6Variant& variant : figure6_variants()) r.figure6.runs.push_back(made_up_run(variant));
  r.inside.ours.median_s = 1e-5;
  r.inside.woodbury.median_s = 1e-3;
  r.table.push_back({"Mesh", "nodes \"n\"", "", 570.0, 573.0, TableCell{}, "a, note"});
  r.table.push_back({"Mesh", "words", "ms", std::string("less than 1"), 2.0, 0.5, ""});
  return r;
}

class ResultFiles : public ::testing::Test {
 protected:
  Folder temporary_;
  fs::path folder_ = temporary_.path();
};

}  // namespace

TEST_F(ResultFiles, a_new_folder_holds_everything_and_nothing_else_is_left) {
  const fs::path out = folder_ / "deep" / "out";
  ASSERT_TRUE(write_reproduction(made_up(), out / "").ok());
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"figure2.json", "figure5.csv", "figure6_bcs_repositioning.csv",
                                                     "figure6_default.csv", "figure6_woodbury_addition.csv",
                                                     "report.html", "reproduce.json", "table.csv"}));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "deep"), {}), 1) << "no part of a folder is left beside it";
}

TEST_F(ResultFiles, a_folder_that_exists_keeps_what_is_not_ours) {
  std::ofstream(folder_ / "mine.txt") << "mine";
  ASSERT_TRUE(write_reproduction(made_up(), folder_).ok());
  EXPECT_EQ(content_of(folder_ / "mine.txt"), "mine");
  EXPECT_TRUE(fs::exists(folder_ / "reproduce.json"));
}

TEST_F(ResultFiles, a_folder_that_cannot_be_made_is_named) {
  std::ofstream(folder_ / "file") << "in the way";
  const auto written = write_reproduction(made_up(), folder_ / "file" / "out");
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message().find("file"), std::string::npos);
}

TEST_F(ResultFiles, json_has_the_keys_that_are_promised) {
  const auto json = nlohmann::json::parse(reproduction_json(made_up()));
  for (const char* key : {"dim", "inverse_s", "bcs_s", "woodbury_s"}) EXPECT_TRUE(json["fig5"][0].contains(key)) << key;
  EXPECT_EQ(json["fig6"]["curves"]["default"], "figure6_default.csv");
  EXPECT_EQ(json["fig6"]["runs"][0]["events"][0]["kind"], "puncture");
  EXPECT_EQ(json["fig6"]["runs"][1]["remeshings"][0]["dimension"], 18);
  EXPECT_EQ(json["fig6"]["runs"][1]["worst_ms"]["with_remeshing"], 5.0);
  for (const char* key : {"quantity", "paper", "reproduced", "default"})
    EXPECT_TRUE(json["table"][0].contains(key)) << key;
  EXPECT_EQ(json["table"][1]["paper"], "less than 1");
  EXPECT_TRUE(json["table"][0]["default"].is_null());
  EXPECT_EQ(json["machine"]["blas_threads"], 1);
}

TEST_F(ResultFiles, curves_and_table_are_sound_csv) {
  ASSERT_TRUE(write_reproduction(made_up(), folder_).ok());
  const std::string curves = content_of(folder_ / "figure6_default.csv");
  EXPECT_EQ(curves.substr(0, curves.find('\n')),
            "iteration,insertion,time_s,base_depth_mm,force_axial_N,force_sagittal_N,force_lateral_N,step_us,"
            "cumulative_s,remeshings,dk_dimension,contacts,sticking,events");
  EXPECT_NE(curves.find("2,1,0.003000,2.000000,0.200000000,0.000000000,0.000000000,5000.000,0.005200000,1,18,0,0,"
                        "puncture:prostate\n"),
            std::string::npos);
  const std::string table = content_of(folder_ / "table.csv");
  EXPECT_NE(table.find("\"Mesh\",\"nodes \"\"n\"\"\",\"\",570,573,,\"a, note\"\n"), std::string::npos);
  EXPECT_EQ(content_of(folder_ / "figure5.csv").substr(0, 33), "dim,change,inverse_s,bcs_s,woodbu");
}

TEST_F(ResultFiles, the_page_stands_alone_and_escapes_what_it_is_given) {
  const auto page = reproduction_page(made_up());
  ASSERT_TRUE(page.ok()) << page.error().message();
  EXPECT_EQ(page->find("{{"), std::string::npos);
  const std::string markup = page->substr(0, page->find("<script"));
  expect_silent(markup, {"http://", "https://"});
  expect_says(markup, {"stylet reproduce -o out &lt;&amp;&gt;", "Not a medical device"});
  for (const char* id : {"figure5-plot", "cumulative-plot", "forces-default", "dimension-plot", "contours", "surface"})
    EXPECT_NE(markup.find("id=\"" + std::string(id) + "\""), std::string::npos) << id;
}

TEST_F(ResultFiles, the_page_says_what_the_numbers_say) {
  Reproduction r = made_up();
  const auto says = [](const Reproduction& reproduction, const std::string& text) {
    const auto page = reproduction_page(reproduction);
    EXPECT_TRUE(page.ok());
    return page.ok() && page->substr(0, page->find("<script")).find(text) != std::string::npos;
  };
  EXPECT_TRUE(says(r, "The methods have the paper’s order at every size."));
  EXPECT_TRUE(
      says(r, "1.50 times as many multiplications (counted) as Woodbury at order 52 and 1.80 times at order 98"));
  EXPECT_TRUE(says(r, "18 times here"));
  EXPECT_TRUE(says(r, "at least 3 repeats"));
  EXPECT_TRUE(says(r, "each was run once"));
  EXPECT_TRUE(says(r, "No mesh changes during a retraction."));
  EXPECT_TRUE(says(r, "the force turned from push to pull before slip in 0, start of slip in 0."));
  EXPECT_TRUE(says(r, "Of 1 changes made"));

  std::swap(r.figure5[0].bcs_s, r.figure5[0].woodbury_s);
  EXPECT_TRUE(says(r, "The methods do not have the paper’s order at every size"));
  r.figure6.repeats = 5;
  EXPECT_TRUE(says(r, "each was run 5 times"));
  for (Figure6Run& run : r.figure6.runs) {
    run.events.push_back({1, 0, {.kind = EventKind::retraction_start, .region = {}}});
    run.events.push_back({4, 0, {.kind = EventKind::slip_start, .region = {}}});
    run.steps[0].force_axial_N = 0.2;
    run.steps[4].force_axial_N = -0.2;
  }
  EXPECT_FALSE(says(r, "the axial force of the default changes")) << "no rest";
  for (Figure6Run& run : r.figure6.runs) run.steps[2].base_depth_mm = run.steps[3].base_depth_mm = 9.0;
  EXPECT_TRUE(says(r, "the axial force of the default changes"));
  EXPECT_TRUE(says(r, "3 changes of the mesh occur during a retraction."));
  EXPECT_TRUE(says(r, "the force turned from push to pull before slip in 3, start of slip in 3."));
}

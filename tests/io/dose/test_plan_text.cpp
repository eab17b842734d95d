// SPDX-License-Identifier: GPL-3.0-or-later
// Plans in JSON and CSV.
#include "io/dose/dose_folder.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/io/scenario_plan.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

class PlanText : public testing_files::InFolder {
 protected:
  void expect_error(const std::string& name, const std::string& text, const std::string& part) const {
    testing_files::expect_refused(read_plan(file(name, text)), part);
  }
  [[nodiscard]] static std::string json(const std::string& rest) {
    return R"({"format": "stylet-plan", "version": 1, "units": "mm", "frame": "LPS", )" + rest + "}";
  }
};

TEST_F(PlanText, in_json_has_seeds_with_one_strength_or_their_own) {
  const DosePlan plan =
      read_plan(file("plan.json", json(R"("strength_U": 0.5, "source": "i125_6711", "prescription_Gy": 145,
        "seeds": [{"position_mm": [1, 2, 3]}, {"position_mm": [4, 5, 6], "axis": [0, 3, 4], "strength_U": 0.6}])")))
          .value();
  ASSERT_EQ(plan.sources.size(), 2U);
  EXPECT_EQ(plan.sources[0].strength_U, 0.5);
  EXPECT_FALSE(plan.sources[0].has_axis);
  EXPECT_EQ(plan.sources[1].strength_U, 0.6);
  EXPECT_LT((plan.sources[1].axis - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(plan.source_model, "i125_6711");
  EXPECT_EQ(plan.prescription_Gy, 145.0);
}

// From the tip: a seed on the retraction plane, two spacers, a seed, and a seed end to end with it.
TEST_F(PlanText, places_the_seeds_of_a_train_behind_the_retraction_plane) {
  const DosePlan plan = read_plan(file("plan.json", json(R"("strength_U": 0.5,
        "template": {"origin_mm": [10, 20, 30]},
        "needles": [{"hole": "e4.5", "retraction_mm": 5, "train": "S-2-S-S"}])")))
                            .value();
  ASSERT_EQ(plan.sources.size(), 3U);
  const Vec3 first(10 + 15, 20 - 5, 25);  // three columns to the left of D, one row to anterior, 5 mm inferior
  EXPECT_LT((plan.sources[0].at_mm - first).norm(), 1e-12) << plan.sources[0].at_mm.transpose();
  EXPECT_LT((plan.sources[1].at_mm - (first - Vec3(0, 0, 4.5 + 11.0))).norm(), 1e-12);
  EXPECT_LT((plan.sources[2].at_mm - (first - Vec3(0, 0, 9.0 + 11.0))).norm(), 1e-12);
  EXPECT_TRUE(plan.sources[0].has_axis);
  EXPECT_EQ(plan.sources[2].needle, "e4.5");
}

TEST_F(PlanText, in_csv_says_the_same_as_in_json) {
  const DosePlan seeds = read_plan(file("seeds.csv",
                                        "# strength_U: 0.5\n# prescription_Gy: 145\n# any comment\n"
                                        "x_mm,y_mm,z_mm,ax,ay,az,needle\n1,2,3,0,0,1,D4\n4,5,6,,,,d3.5\n"))
                             .value();
  ASSERT_EQ(seeds.sources.size(), 2U);
  EXPECT_EQ(seeds.sources[1].at_mm, Vec3(4, 5, 6));
  EXPECT_TRUE(seeds.sources[0].has_axis);
  EXPECT_FALSE(seeds.sources[1].has_axis);
  EXPECT_EQ(seeds.sources[1].needle, "d3.5");
  EXPECT_EQ(seeds.prescription_Gy, 145.0);
  const DosePlan needles = read_plan(file("needles.csv",
                                          "# strength_U: 0.5\n# template_origin_mm: 10 20 30\n"
                                          "hole,retraction_mm,train\nD4,0,S-1-S\nd4,5,1-S\n"))
                               .value();
  ASSERT_EQ(needles.sources.size(), 3U);
  EXPECT_LT((needles.sources[0].at_mm - Vec3(10, 20, 30)).norm(), 1e-12);
  EXPECT_LT((needles.sources[1].at_mm - Vec3(10, 20, 20)).norm(), 1e-12);
  EXPECT_LT((needles.sources[2].at_mm - Vec3(15, 20, 25 + 2.25 - 5.5 - 2.25)).norm(), 1e-12);
}

TEST_F(PlanText, in_a_scenario_says_the_same_as_in_csv) {
  const DosePlan csv = read_plan(file("needles.csv",
                                      "# strength_U: 0.5\n# template_origin_mm: 10 20 30\n# prescription_Gy: 145\n"
                                      "# label: mine\n# source: i125_6711\nhole,retraction_mm,train,strength_U\n"
                                      "D4,0,S-1-S,\nd4,5,1-S,0.6\ne3.5,2.5,S-2-S-S,\n"))
                           .value();
  const Result<Scenario> scenario = parse_scenario(R"(
[patient]
source = "phantom"
[template]
centre_mm = [10, 20]
[plan]
label = "mine"
strength_U = 0.5
prescription_Gy = 145
base_mm = 30
[[plan.needle]]
hole = "D4"
train = "S-1-S"
[[plan.needle]]
hole = "d4"
retraction_mm = 5
train = "1-S"
strength_U = 0.6
[[plan.needle]]
hole = "e3.5"
retraction_mm = 2.5
train = "S-2-S-S"
)",
                                                   "case.toml");
  ASSERT_TRUE(scenario) << scenario.error().message();
  const DosePlan plan = plan_of_scenario(*scenario, "case.toml").value();
  EXPECT_EQ(plan.file, "case.toml");
  EXPECT_EQ(plan.label, csv.label);
  EXPECT_EQ(plan.implant, csv.implant);
  EXPECT_EQ(plan.prescription_Gy, csv.prescription_Gy);
  ASSERT_EQ(plan.sources.size(), csv.sources.size());
  for (std::size_t k = 0; k < csv.sources.size(); ++k) {
    EXPECT_EQ(plan.sources[k].at_mm, csv.sources[k].at_mm) << k;
    EXPECT_EQ(plan.sources[k].axis, csv.sources[k].axis) << k;
    EXPECT_EQ(plan.sources[k].has_axis, csv.sources[k].has_axis) << k;
    EXPECT_EQ(plan.sources[k].strength_U, csv.sources[k].strength_U) << k;
    EXPECT_EQ(plan.sources[k].needle, csv.sources[k].needle) << k;
  }
}

TEST_F(PlanText, in_a_scenario_may_give_lines_and_places_instead_of_holes_and_trains) {
  Scenario scenario;
  scenario.plan.base_mm = 30.0;
  scenario.plan.strength_U = 0.5;
  scenario.plan.needles.resize(2);
  scenario.plan.needles[0].at_mm = {1.0, 2.0};
  scenario.plan.needles[0].retraction_mm = 5.0;
  scenario.plan.needles[0].seeds_mm = {0.0, 10.0, 25.5};
  scenario.plan.needles[1].at_mm = {-1.0, 2.0};
  scenario.plan.needles[1].train = "S-1-S";
  const DosePlan plan = plan_of_scenario(scenario, "case.toml").value();
  ASSERT_EQ(plan.sources.size(), 5U);
  for (const auto& [seed, z] : {std::pair(0, 25.0), std::pair(1, 15.0), std::pair(2, -0.5)})
    EXPECT_LT((plan.sources[static_cast<std::size_t>(seed)].at_mm - Vec3(1, 2, z)).norm(), 1e-12);
  EXPECT_LT((plan.sources[4].at_mm - Vec3(-1, 2, 20)).norm(), 1e-12);
  EXPECT_EQ(plan.sources[0].needle, "needle 1");
  EXPECT_EQ(plan.sources[4].needle, "needle 2");

  const auto says = [&](const std::string& part) {
    testing_files::expect_refused(plan_of_scenario(scenario, "case.toml"), part);
  };
  scenario.plan.needles[1].train = "S-x-S";
  says("case.toml, plan.needle[1]: element 2 of the train 'S-x-S' is 'x'");
  scenario.plan.needles[1].train = "S";
  scenario.plan.strength_U = 0.0;
  says("case.toml, plan.needle[0]: the air-kerma strength is missing");
  scenario.plan = {};
  says("case.toml: the scenario has no plan");
}

TEST_F(PlanText, goals_of_a_scenario_are_those_of_the_same_table_as_csv) {
  const auto csv = read_goals(file("goals.csv",
                                   "structure,metric,bound,citation\nprostate,D90_percent,>=100,our protocol\n"
                                   "rectum,D2cc_Gy,<145,\n"))
                       .value();
  Scenario scenario;
  EXPECT_FALSE(goals_of_scenario(scenario, "case.toml").value().has_value());
  scenario.plan.goal_table = {{"prostate", "D90_percent", ">=100", "our protocol"}, {"rectum", "D2cc_Gy", "<145", ""}};
  const auto tables = goals_of_scenario(scenario, "case.toml").value();
  ASSERT_TRUE(tables.has_value());
  ASSERT_EQ(tables->size(), csv.size());
  for (std::size_t k = 0; k < csv.size(); ++k) {
    EXPECT_EQ((*tables)[k].structure, csv[k].structure);
    EXPECT_EQ((*tables)[k].metric, csv[k].metric);
    EXPECT_EQ((*tables)[k].at_least, csv[k].at_least);
    EXPECT_EQ((*tables)[k].bound, csv[k].bound);
    EXPECT_EQ((*tables)[k].citation, csv[k].citation);
  }
}

TEST_F(PlanText, that_is_written_is_read_again_exactly) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-60.0, 60.0);
  for (const Implant implant : {Implant::permanent, Implant::temporary}) {
    DosePlan plan;
    plan.label = "a \"plan\"";
    plan.implant = implant;
    for (int k = 0; k < 20; ++k) {
      PlannedSource s;
      s.at_mm = Vec3(place(random), place(random), place(random));
      s.axis = Vec3(place(random), place(random), place(random)).normalized();
      s.has_axis = k % 2 == 0;
      s.strength_U = std::abs(place(random)) + 0.1;
      if (implant == Implant::temporary) s.dwell_s = std::abs(place(random));
      plan.sources.push_back(s);
    }
    const auto path = folder / "plan.json";
    ASSERT_TRUE(write_plan_json(plan, path).ok());
    const DosePlan back = read_plan(path).value();
    ASSERT_EQ(back.sources.size(), plan.sources.size());
    EXPECT_EQ(back.label, plan.label);
    EXPECT_EQ(back.implant, implant);
    for (std::size_t k = 0; k < plan.sources.size(); ++k) {
      EXPECT_EQ(back.sources[k].at_mm, plan.sources[k].at_mm);
      EXPECT_EQ(back.sources[k].strength_U, plan.sources[k].strength_U);
      EXPECT_EQ(back.sources[k].dwell_s, plan.sources[k].dwell_s);
      EXPECT_EQ(back.sources[k].has_axis, plan.sources[k].has_axis);
      if (plan.sources[k].has_axis) EXPECT_LT((back.sources[k].axis - plan.sources[k].axis).norm(), 1e-15);
    }
  }
}

TEST_F(PlanText, names_the_place_and_the_cure_of_each_fault) {
  const std::string seed = R"("seeds": [{"position_mm": [1, 2, 3]}])";
  expect_error("a.json", json(seed), "strength is missing");
  expect_error("b.json", json("\"strength_U\": -1, " + seed), "-1 U");
  expect_error("d.json", json(R"("strength_U": 0.5, "seed": [])"), "Did you mean 'seeds'");
  expect_error("e.json", json(R"("strength_U": 0.5, "seeds": [{"position_mm": [1, 2]}])"), "three numbers");
  expect_error("f.json", json(R"("strength_U": 0.5, "seeds": [{"axis": [0, 0, 1]}])"), "no position_mm");
  expect_error("g.json", json(R"("strength_U": 0.5)"), "no seed");
  expect_error("h.json", json(R"("strength_U": 0.5, "seeds": [{"position_mm": [1, 2, 3], "axis": [0, 0, 0]}])"),
               "axis");
  expect_error("i.json", json(R"("strength_U": 0.5, "needles": [{"hole": "D4", "train": "S"}])"), "no template");
  const std::string grid = R"("strength_U": 0.5, "template": {"origin_mm": [0, 0, 0]}, )";
  expect_error("j.json", json(grid + R"("needles": [{"hole": "Q9", "train": "S"}])"), "no such hole");
  expect_error("k.json", json(grid + R"("needles": [{"hole": "D4", "train": "S-x-S"}])"), "element 2");
  expect_error("l.json", json(grid + R"("needles": [{"hole": "D4", "train": "2-2"}])"), "no seed");
  expect_error("m.json", R"({"format": "stylet-plan", "version": 1, "units": "cm", "frame": "LPS"})", "'cm'");
  expect_error("n.json", R"({"format": "stylet-plan", "version": 1, )", "not valid JSON");
  expect_error("o.csv", "x_mm,y_mm,z_mm\n1,2,nan\n", "column z_mm");
  expect_error("p.csv", "x_mm,y_mm,z_mm,strength_U\n1,2,3\n", "3 fields");
  expect_error("q.csv", "x_mm,y_mm,z_mn\n1,2,3\n", "Did you mean 'z_mm'");
  expect_error("r.csv", "hole,retraction_mm,train\nD4,0,S\n", "template_origin_mm");
}

TEST_F(PlanText, keeps_what_the_rules_for_plans_judge) {
  const DosePlan seeds = read_plan(file("a.csv",
                                        "# strength_mCi: 0.4\n# Note: mine\nx_mm,y_mm,z_mm,strength_U,dwell_s\n"
                                        "1,2,3,0.5,7\n1,2,3.001,0.5,\n"))
                             .value();
  EXPECT_EQ(seeds.sources.size(), 2U);
  EXPECT_EQ(seeds.says.dwell_of_permanent_s, 7.0);
  EXPECT_EQ(seeds.says.ignored, std::vector<std::string>{"# strength_mCi: 0.4"});
  const std::string lines = "# implant: temporary\nx_mm,y_mm,z_mm,strength_U,dwell_s\n1,2,3,40000,7\n1,2,4,40000,\n";
  EXPECT_EQ(read_plan(file("b.csv", lines)).value().says.without_dwell_time, 1U);
}

TEST_F(PlanText, may_name_a_source_for_each_seed) {
  const std::string head = "x_mm,y_mm,z_mm,strength_U,source\n1,2,3,0.5,i125_6711\n";
  const DosePlan plan = read_plan(file("plan.csv", head + "1,2,9,2,pd103_theraseed200\n1,9,3,0.5,i125_6711\n")).value();
  ASSERT_EQ(kind_count(plan), 2U);
  EXPECT_EQ(source_kind(plan, 1).source_model, "pd103_theraseed200");
  EXPECT_EQ(plan.sources[1].kind, 1U);
  EXPECT_EQ(plan.sources[2].kind, 0U);
  ASSERT_TRUE(write_plan_json(plan, folder / "again.json").ok());
  EXPECT_EQ(kind_count(read_plan(folder / "again.json").value()), 2U);
  expect_error("none.csv", head + "1,2,9,0.5,\n", "names no source");
}

TEST_F(PlanText, is_recognised_by_its_content) {
  EXPECT_EQ(dose_file_kind(file("a", json("\"seeds\": []"))), DoseFileKind::plan);
  EXPECT_EQ(dose_file_kind(file("b.csv", "# hello\nx_mm,y_mm,z_mm\n1,2,3\n")), DoseFileKind::plan);
  EXPECT_EQ(dose_file_kind(file("c.json", R"({"format": "stylet-source"})")), DoseFileKind::source_model);
  EXPECT_EQ(dose_file_kind(file("d.json", R"({"format": "stylet-contours"})")), DoseFileKind::none);
  EXPECT_EQ(dose_file_kind(folder / "absent"), DoseFileKind::none);
}

}  // namespace
}  // namespace stylet

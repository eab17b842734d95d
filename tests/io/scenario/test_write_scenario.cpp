// SPDX-License-Identifier: GPL-3.0-or-later
#include "support.hpp"

#include <algorithm>
#include <random>
#include <set>
#include <sstream>

using namespace stylet;
using namespace stylet::test;

namespace {

Scenario minimal() {
  Scenario s;
  s.patient.source = "phantom";
  s.insertions.resize(1);
  s.insertions[0].hole = "D4";
  return s;
}

/// With a needle and a goal of a plan of its own.
Scenario with_plan_needle(Scenario s) {
  s.plan.base_mm = 40.0;
  s.plan.needles.resize(1);
  s.plan.needles[0].at_mm = {10.0, 5.5};
  s.plan.needles[0].seeds_mm = {0.0, 10.0};
  s.plan.needles[0].strength_U = 0.5;
  s.plan.goal_table = {{"prostate", "D90_percent", ">=100", "our protocol"}};
  return s;
}

Scenario read_back(const std::string& text) {
  const Folder folder;
  const auto scenario = read_scenario(write_file(folder / "case.toml", text));
  if (!scenario) {
    ADD_FAILURE() << scenario.error().message() << "\n" << text;
    return {};
  }
  return *scenario;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The schema without the # before each key.
std::string uncommented(const std::string& text) {
  std::string out;
  for (const std::string& line : lines_of(text)) {
    out += (line.size() > 1 && line[0] == '#' && line[1] != ' ' ? line.substr(1) : line) + "\n";
  }
  return out;
}

}  // namespace

TEST(ToToml, reads_back_as_the_same_scenario) { EXPECT_EQ(read_back(to_toml(minimal())), minimal()); }

TEST(ToToml, keeps_the_needles_and_goals_of_a_plan) {
  Scenario s = minimal();
  s.insertions.clear();
  s.grid.centre_mm = {1.5, -2.0};
  s.plan.label = "from \"notes\"";
  s.plan.source = "i125_6711";
  s.plan.strength_U = 0.5;
  s.plan.prescription_Gy = 145.0;
  s.plan.base_mm = 40.25;
  s.plan.needles.resize(3);
  s.plan.needles[0].hole = "D4";
  s.plan.needles[0].train = "S-1-S";
  s.plan.needles[1].at_mm = {10.0, 5.5};
  s.plan.needles[1].retraction_mm = 5.0;
  s.plan.needles[1].seeds_mm = {0.0, 10.0, 25.5};
  s.plan.needles[1].strength_U = 0.6;
  s.plan.needles[1].stranded = true;
  s.plan.needles[2].hole = "e3.5";
  s.plan.needles[2].train = "S";
  s.plan.needles[2].stranded = false;
  s.plan.goal_table = {{"prostate", "D90_percent", ">=100", "our protocol"}, {"rectum", "D2cc_Gy", "<145", ""}};
  const Scenario back = read_back(to_toml(s));
  EXPECT_EQ(back.plan, s.plan);
  EXPECT_EQ(back, s);
}

TEST(ToToml, reads_back_whatever_is_set) {
  Scenario s = minimal();
  s.name = "quotes \" backslash \\ tab \t line\nend ü 前 '''";
  s.patient.source = "/data/a \"strange\" name.dcm";
  s.patient.scale = 0.1;
  s.patient.regions_from = "gmsh:physical";
  s.patient.regions = {
      {"1", "peripheral_zone"}, {"GTV 1.5", "prostate"}, {"", "band"}, {"ümlaut", "body"}, {"a\"b", "x"}};
  s.patient.regions.erase("");
  s.tissue["prostate"] = default_tissue("prostate");
  s.tissue["prostate"].young_kPa = 1.0 / 3.0;
  s.tissue["a.b c"] = default_tissue("a.b c");
  s.tissue["a.b c"].friction_viscous_Ns_per_m2 = 1e-7;
  s.fixed.regions = {"pubic_arch", "a \"b\""};
  s.fixed.outer = OuterSupport::all;
  s.fixed.box_mm = {-1e5, -2.5, 1e-9, 1e5, 2.5, 2e-9};
  s.mesh = {1234567 / 2, MeshPreset::paper, 0.0, false};
  s.needle.length_mm = 123.456;
  s.needle.diameter_mm = 0.889;
  s.needle.lumen_diameter_mm = 1.0 / 3.0;
  s.needle.stylet = StyletPlace::in;
  s.needle.bending_stiffness_Nmm2 = 1e7;
  s.needle.torsion_stiffness_Nmm2 = 1.0;
  s.needle.bevel_deg = 22.5;
  s.needle.bevel_law = Bevel::Law::force;
  s.needle.elements = 200;
  s.coupling = {.method = CouplingSettings::Method::embedded,
                .rule = CouplingSettings::Rule::paper,
                .solver = CouplingSettings::Solver::staggered,
                .engine = CouplingSettings::Engine::bcs,
                .damping = 1.25,
                .projection = Projection::nearest_node,
                .spacing_mm = 49.999999999999,
                .tip_viscosity_Ns_per_m = 0.01,
                .bone_damping_ms = 0.75,
                .grazing_deg = 30,
                .corridor_mm = 1.5,
                .corridor_nodes = 8};
  s.grid.pitch_mm = 4.2;
  s.grid.centre_mm = {-0.1, 1e4};
  s.grid.columns = {"α", "D"};
  s.grid.rows = {"4", "5"};
  InsertionPlan entry;
  entry.entry_mm = {0.1, 0.2, -80.3};
  entry.direction = {0, 1e-3, 1};
  entry.approach_mm = 0.7;
  entry.depth_mm = 12.3;
  entry.speed_mm_per_s = 0.01;
  entry.dwell_s = 0;
  entry.retract_speed_mm_per_s = 333.3;
  InsertionPlan aimed;
  aimed.entry_mm = {0.1, 0.2, -80.3};
  aimed.target_mm = {0.1, 0.2, 1.0 / 7.0};
  aimed.retract = false;
  InsertionPlan recorded;
  recorded.motion = "/data/hand.csv";
  s.insertions.insert(s.insertions.end(), {entry, recorded, aimed});
  s.run.dt_ms = 0.25;
  s.output = {0.0, 5000, false};
  EXPECT_EQ(read_back(to_toml(s)), s);
  EXPECT_EQ(to_toml(read_back(to_toml(s))), to_toml(s));
}

TEST(ToToml, keeps_every_number_to_its_last_bit) {
  std::mt19937_64 random(7);
  Scenario s = with_plan_needle(minimal());
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.type != ScenarioValue::Type::number || key.path.find_first_of("<[") != std::string::npos) continue;
    const double low = std::stod(key.range);
    const double high = std::stod(key.range.substr(key.range.find("… ") + 4));
    std::uniform_real_distribution<double> any(low, high);
    const auto set = set_scenario_key(s, key.path, {.type = ScenarioValue::Type::number, .number = any(random)}, "");
    ASSERT_TRUE(set.ok()) << set.error().message();
  }
  s.coupling.spacing_mm = std::max(s.coupling.spacing_mm, s.needle.diameter_mm);
  s.coupling.solver = CouplingSettings::Solver::staggered;  // needed for damping
  EXPECT_EQ(read_back(to_toml(s)), s);
}

TEST(ToToml, keeps_a_plan_of_seeds_and_its_procedure) {
  Scenario s = minimal();
  s.insertions.clear();
  s.plan = {.file = "/plans/plan.csv", .source = "i125_6711", .goals = "/plans/goals.csv"};
  s.procedure.technique = SeedTechnique::pushed;
  s.procedure.order = NeedleOrder::posterior_first;
  s.seed = {.stranded = true, .release_mm = -1.0, .release_sd_mm = 0.5, .loss_percent = 1.0, .random = 9};
  s.oedema.swelling_percent = {10.0, 20.0, 30.0};
  EXPECT_EQ(read_back(to_toml(s)), s);
}

TEST(ToToml, writes_every_key_that_has_a_value_with_its_unit) {
  Scenario s = with_plan_needle(minimal());
  s.tissue["prostate"] = default_tissue("prostate");
  const auto lines = lines_of(to_toml(s));
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.standard == "none" || key.path.ends_with(".direction") || key.path == "template.centre_mm" ||
        key.path == "patient.regions.<name>" || key.path == "tissue.creep")
      continue;
    if (key.path.starts_with("needle.") && !scenario_value(s, key.path)) continue;   // computed from other keys
    if (key.path.ends_with(".stranded") && key.path.starts_with("plan.")) continue;  // the default is seed.stranded
    const std::string name = key.path.substr(key.path.rfind('.') + 1) + " = ";
    const auto line =
        std::find_if(lines.begin(), lines.end(), [&](const std::string& l) { return l.starts_with(name); });
    ASSERT_NE(line, lines.end()) << key.path;
    EXPECT_TRUE(key.unit.empty() || line->ends_with("# " + key.unit)) << *line;
  }
}

TEST(Schema, has_every_key_once) {
  const auto lines = lines_of(schema_text());
  std::multiset<std::string> found;
  std::string table;
  for (std::string line : lines) {
    if (line.starts_with("#[[")) line.erase(0, 1);  // a list that may be empty is commented out with its keys
    if (line.starts_with("["))
      table = line.substr(line.find_first_not_of('['), line.find(']') - line.find_first_not_of('[')) +
              (line.starts_with("[[") ? "[]." : ".");
    if (line.size() > 1 && line[0] == '#' && line[1] != ' ') found.insert(table + line.substr(1, line.find(" = ") - 1));
  }
  EXPECT_EQ(found.size(), scenario_keys().size());
  for (const ScenarioKey& key : scenario_keys()) {
    std::string path = key.path;
    if (const auto at = path.find("<region>"); at != std::string::npos) path.replace(at, 8, "prostate");
    if (const auto at = path.find("<name>"); at != std::string::npos) path.replace(at, 6, "\"1\"");
    EXPECT_EQ(found.count(path), 1U) << path;
  }
}

TEST(Schema, names_unit_range_default_and_meaning_of_every_key) {
  std::string text = schema_text();
  // Remove the line breaks of long comments.
  for (auto at = text.find("\n# "); at != std::string::npos; at = text.find("\n# ", at)) text.replace(at, 3, " ");
  const auto lines = lines_of(text);
  for (const ScenarioKey& key : scenario_keys()) {
    const std::string name = key.path.substr(key.path.rfind('.') + 1);
    const std::string start = "#" + (name == "<name>" ? "\"1\"" : name) + " = ";
    bool found = false;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const std::string& about = lines[i - 1];
      if (!lines[i].starts_with(start) || about.find(key.meaning.substr(1)) == std::string::npos) continue;
      found = true;
      EXPECT_EQ(lines[i], start + key.example);
      EXPECT_TRUE(key.unit.empty() || about.find(" " + key.unit + ".") != std::string::npos) << about;
      EXPECT_TRUE(key.range == "text" || about.find(key.range.substr(1)) != std::string::npos) << about;
      if (key.standard == "required") {
        EXPECT_NE(about.find("Required."), std::string::npos) << about;
      } else if (key.standard != key.example) {
        EXPECT_NE(about.find("Default: " + key.standard + "."), std::string::npos) << about;
      }
    }
    EXPECT_TRUE(found) << key.path;
  }
}

TEST(Schema, is_at_most_110_columns_wide) {
  for (const std::string& line : lines_of(schema_text())) {
    const auto characters =
        std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    EXPECT_LE(characters, 110) << line;
    EXPECT_FALSE(line.ends_with(' ')) << line;
  }
}

TEST(Schema, is_a_toml_file_that_lacks_only_a_patient) {
  const Folder folder;
  expect_says(refusal(read_scenario(write_file(folder / "my.toml", schema_text()))), {"there is no patient"});
}

TEST(Schema, runs_once_source_and_hole_are_uncommented) {
  std::string text = schema_text();
  for (const char* key : {"#source = ", "#hole = "}) text.erase(text.find(key), 1);
  EXPECT_EQ(read_back(text), minimal());
}

TEST(Schema, shows_values_that_are_taken) {
  std::string text = uncommented(schema_text());
  // Keep only one of the keys that determine the needle's way, and one of those that determine plan, seeds and goals.
  for (const char* other :
       {"\nentry_mm", "\ndirection", "\ntarget_mm", "\nmotion", "\nfile", "\ngoals", "\nat_mm", "\nseeds_mm"})
    text.insert(text.find(other) + 1, "#");
  const Scenario s = read_back(text);
  EXPECT_EQ(s.tissue.at("prostate"), default_tissue("prostate"));
  EXPECT_EQ(s.insertions, minimal().insertions);
  Scenario::NeedleChoice needle = s.needle;  // for keys that are unset by default, the schema shows an example
  EXPECT_TRUE(needle.lumen_diameter_mm && needle.stylet_diameter_mm && needle.bending_stiffness_Nmm2);
  needle.lumen_diameter_mm.reset();
  needle.stylet_diameter_mm.reset();
  needle.bending_stiffness_Nmm2.reset();
  needle.torsion_stiffness_Nmm2.reset();
  EXPECT_EQ(needle, minimal().needle);
  EXPECT_EQ(s.coupling, minimal().coupling);
  EXPECT_EQ(s.patient.regions.at("1"), "peripheral_zone");
}

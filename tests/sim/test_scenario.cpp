// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/model.hpp"
#include "stylet/sim/scenario.hpp"
#include "stylet/sim/tenting.hpp"

#include <gtest/gtest.h>

#include <array>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

using namespace stylet;

namespace {

using Type = ScenarioValue::Type;

ScenarioValue number(double x) { return {.type = Type::number, .number = x}; }
ScenarioValue whole(double x) { return {.type = Type::integer, .number = x}; }
ScenarioValue truth(bool x) { return {.type = Type::boolean, .boolean = x}; }
ScenarioValue text(std::string x) { return {.type = Type::text, .text = std::move(x)}; }
ScenarioValue numbers(std::vector<double> x) { return {.type = Type::numbers, .numbers = std::move(x)}; }
ScenarioValue texts(std::vector<std::string> x) { return {.type = Type::texts, .texts = std::move(x)}; }

/// Message of the error when a key is set; empty if there is none.
std::string refusal(const std::string& path, const ScenarioValue& value) {
  Scenario scenario;
  const Scenario before = scenario;
  const auto set = set_scenario_key(scenario, path, value, "case.toml, line 7");
  if (set) return {};
  EXPECT_EQ(scenario, before) << "a refused value of " << path << " left something behind";
  EXPECT_EQ(set.error().kind, ErrorKind::input);
  EXPECT_EQ(set.error().where, "case.toml, line 7");
  EXPECT_FALSE(set.error().cure.empty());
  return set.error().message();
}

Scenario runnable() {
  Scenario s;
  s.patient.source = "phantom";
  s.insertions.resize(1);
  s.insertions[0].hole = "D4";
  return s;
}

/// Message of the error of a scenario, with the path for which the place was asked; empty if there is none.
std::string complaint(const Scenario& scenario) {
  const auto checked = check_scenario(scenario, [](const std::string& path) { return "at <" + path + ">"; });
  if (checked) return {};
  EXPECT_EQ(checked.error().kind, ErrorKind::input);
  EXPECT_FALSE(checked.error().cure.empty());
  return checked.error().message();
}

#define EXPECT_SAYS(message, part) EXPECT_NE((message).find(part), std::string::npos) << (message)

/// A path with the wildcards of a key filled in.
std::string filled_in(std::string path) {
  const auto replace = [&](const std::string& what, const std::string& by) {
    if (const auto at = path.find(what); at != std::string::npos) path.replace(at, what.size(), by);
  };
  replace("<region>", "prostate");
  replace("<name>", "PROSTATE");
  replace("[]", "[0]");
  return path;
}

}  // namespace

TEST(ScenarioKeys, every_key_is_documented_once) {
  std::set<std::string> seen;
  for (const ScenarioKey& key : scenario_keys()) {
    EXPECT_TRUE(seen.insert(key.path).second) << key.path << " twice";
    EXPECT_FALSE(key.standard.empty()) << key.path;
    EXPECT_FALSE(key.range.empty()) << key.path;
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    EXPECT_FALSE(key.example.empty()) << key.path;
  }
  EXPECT_GT(seen.size(), 50U);
}

TEST(ScenarioKeys, a_key_named_with_a_unit_has_that_unit) {
  const std::vector<std::pair<std::string, std::string>> endings{
      {"_kPa", "kPa"},        {"_N", "N"},   {"_N_per_m", "N/m"}, {"_Ns_per_m2", "N s/m²"},
      {"_Ns_per_m", "N s/m"}, {"_mm", "mm"}, {"_Nmm2", "N mm²"},  {"_deg", "degree"},
      {"_mm_per_s", "mm/s"},  {"_s", "s"},   {"_ms", "ms"},       {"_per_s", "1/s"}};
  for (const ScenarioKey& key : scenario_keys()) {
    std::string ending;
    std::string unit;
    for (const auto& [e, u] : endings) {
      if (key.path.ends_with(e) && e.size() > ending.size()) ending = e, unit = u;
    }
    if (ending.empty()) continue;
    EXPECT_EQ(key.unit, unit) << key.path;
  }
}

TEST(ScenarioKeys, the_documented_default_is_the_one_a_new_scenario_has) {
  Scenario fresh;
  fresh.insertions.resize(1);
  fresh.tissue["prostate"] = default_tissue("prostate");
  for (const ScenarioKey& key : scenario_keys()) {
    const auto value = scenario_value(fresh, filled_in(key.path));
    if (!value || (value->type == Type::text && value->text.empty()) || key.standard == "by region") continue;
    if (key.path == "fixed.regions") continue;  // the empty list means the bones
    EXPECT_EQ(to_string(*value), key.standard) << key.path;
  }
}

TEST(ScenarioKeys, a_value_that_is_set_is_the_value_that_is_read) {
  const std::vector<std::pair<std::string, ScenarioValue>> values{
      {"name", text("a \"quoted\" name")},
      {"patient.source", text("p.dcm")},
      {"patient.scale", number(1000)},
      {"patient.regions_from", text("tissue")},
      {"patient.regions.GTV 1.5", text("prostate")},
      {"tissue.prostate.young_kPa", number(17.25)},
      {"tissue.a.b.puncture_N", number(0.5)},
      {"fixed.regions", texts({"pubic_arch", "band"})},
      {"fixed.box_mm", numbers({-1, -2, -3, 1, 2, 3})},
      {"mesh.nodes", whole(1234)},
      {"mesh.stiff_band", truth(false)},
      {"needle.length_mm", number(180)},
      {"coupling.rule", text("paper")},
      {"template.centre_mm", numbers({3, 4})},
      {"template.rows", texts({"1", "2"})},
      {"insertion[0].hole", text("D4")},
      {"insertion[2].direction", numbers({0, 0.1, 1})},
      {"output.pictures", truth(false)},
  };
  Scenario scenario;
  for (const auto& [path, value] : values) {
    const auto set = set_scenario_key(scenario, path, value, "here");
    ASSERT_TRUE(set.ok()) << set.error().message();
    const auto read = scenario_value(scenario, path);
    ASSERT_TRUE(read.has_value()) << path;
    EXPECT_EQ(to_string(*read), to_string(value)) << path;
  }
  EXPECT_EQ(scenario.insertions.size(), 3U);
  EXPECT_DOUBLE_EQ(scenario.tissue.at("prostate").young_kPa, 17.25);
  EXPECT_EQ(scenario.tissue.at("prostate").poisson, default_tissue("prostate").poisson) << "the rest is the default";
  EXPECT_DOUBLE_EQ(scenario.tissue.at("a.b").puncture_N, 0.5);
  EXPECT_EQ(scenario.patient.regions.at("GTV 1.5"), "prostate");
}

TEST(ScenarioKeys, a_whole_number_may_be_written_with_a_decimal_point) {
  EXPECT_EQ(refusal("mesh.nodes", number(3000.0)), "");
  EXPECT_EQ(refusal("needle.length_mm", whole(150)), "");
}

TEST(ScenarioKeys, an_empty_list_is_a_list_of_any_kind) {
  EXPECT_EQ(refusal("fixed.regions", numbers({})), "");
  EXPECT_SAYS(refusal("fixed.box_mm", texts({})), "0 numbers long, not 6");
}

TEST(ScenarioKeys, a_value_that_is_not_set_is_no_value) {
  const Scenario fresh;
  EXPECT_FALSE(scenario_value(fresh, "template.centre_mm").has_value());
  EXPECT_FALSE(scenario_value(fresh, "insertion[0].speed_mm_per_s").has_value());
  EXPECT_FALSE(scenario_value(fresh, "tissue.prostate.young_kPa").has_value());
  EXPECT_FALSE(scenario_value(fresh, "patient.regions.1").has_value());
  EXPECT_FALSE(scenario_value(fresh, "no.such_key").has_value());
}

TEST(ScenarioKeys, a_value_out_of_range_is_refused_with_value_range_and_unit) {
  const std::string poisson = refusal("tissue.prostate.poisson", number(0.5));
  EXPECT_SAYS(poisson, "tissue.prostate.poisson = 0.5 is outside its range");
  EXPECT_SAYS(poisson, "0 … 0.4999");
  const std::string length = refusal("needle.length_mm", number(0.2));
  EXPECT_SAYS(length, "needle.length_mm = 0.2 is outside its range");
  EXPECT_SAYS(length, "20 … 1000 mm");
  EXPECT_SAYS(refusal("insertion[0].entry_mm", numbers({0, 0, 2e4})),
              "insertion[0].entry_mm = [0, 0, 20000] is outside");
}

TEST(ScenarioKeys, numbers_that_are_none_are_refused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.type != Type::number && key.type != Type::integer) continue;
    for (const double x : {nan, inf, -inf})
      EXPECT_SAYS(refusal(filled_in(key.path), number(x)), "not finite") << key.path;
  }
  EXPECT_SAYS(refusal("insertion[0].direction", numbers({0, nan, 1})), "insertion[0].direction = [0, nan, 1]");
}

TEST(ScenarioKeys, every_limit_is_the_documented_one) {
  // The documented range "low … high" determines which values must be accepted and which refused.
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.type != Type::number && key.type != Type::integer) continue;
    const auto dots = key.range.find(" … ");
    ASSERT_NE(dots, std::string::npos) << key.path;
    const double low = std::stod(key.range.substr(0, dots));
    const double high = std::stod(key.range.substr(dots + std::string(" … ").size()));
    const double step = key.type == Type::integer ? 1.0 : 1e-6 * std::max(1.0, std::abs(high));
    const std::string path = filled_in(key.path);
    EXPECT_EQ(refusal(path, number(low)), "");
    EXPECT_EQ(refusal(path, number(high)), "");
    EXPECT_NE(refusal(path, number(low - step)), "") << path;
    EXPECT_NE(refusal(path, number(high + step)), "") << path;
  }
}

TEST(ScenarioKeys, a_value_of_another_type_is_refused_with_the_right_one) {
  EXPECT_SAYS(refusal("needle.length_mm", text("200")), "needle.length_mm = \"200\" is not a number");
  EXPECT_SAYS(refusal("mesh.nodes", number(570.5)), "mesh.nodes = 570.5 is not a whole number");
  EXPECT_SAYS(refusal("mesh.stiff_band", whole(1)), "mesh.stiff_band = 1 is not true or false");
  EXPECT_SAYS(refusal("mesh.stiff_band", text("yes")), "Give true or false, without quotes");
  EXPECT_SAYS(refusal("insertion[0].hole", number(4)), "insertion[0].hole = 4 is not a text in quotes");
  EXPECT_SAYS(refusal("insertion[0].hole", number(4)), "for example \"D4\"");
  EXPECT_SAYS(refusal("insertion[0].entry_mm", number(4)), "3 numbers, each -10000 … 10000 mm");
  EXPECT_SAYS(refusal("fixed.regions", text("pubic_arch")), "for example [\"pubic_arch\"]");
}

TEST(ScenarioKeys, a_word_that_is_not_offered_is_refused_with_those_that_are) {
  const std::string method = refusal("coupling.method", text("nod-addition"));
  EXPECT_SAYS(method, "did you mean \"node-addition\"?");
  EXPECT_SAYS(method, "\"embedded\"");
  EXPECT_SAYS(method, "Give one of \"near-field\", \"node-addition\"");
}

TEST(ScenarioKeys, an_unknown_key_is_refused_with_the_nearest_known_one) {
  const std::vector<std::pair<std::string, std::string>> meant{
      {"needle.lenght_mm", "needle.length_mm"},
      {"tissue.prostate.youngs_kPa", "tissue.prostate.young_kPa"},
      {"insertion[3].deph_mm", "insertion[3].depth_mm"},
      {"insertion.depth_mm", "insertion[0].depth_mm"},
      {"mesh.length_mm", "needle.length_mm"},
      {"tissue.young_kPa", "tissue.REGION.young_kPa"},
      {"nam", "name"},
      {"nodes", "mesh.nodes"},
  };
  for (const auto& [typed, known] : meant) {
    const std::string message = refusal(typed, number(1));
    EXPECT_SAYS(message, "unknown key " + typed);
    EXPECT_SAYS(message, "Did you mean " + known + "?");
  }
  EXPECT_SAYS(refusal("mesh.temperature", number(1)), "stylet insert --print-schema");
}

TEST(ScenarioKeys, a_malformed_path_is_an_unknown_key) {
  for (const char* path : {"", ".", "insertion[", "insertion[]", "insertion[].hole", "insertion[x].hole",
                           "insertion[-1].hole", "insertion[1000].hole", "insertion[99999999999999999999].hole",
                           "tissue.", "tissue..young_kPa", "patient.regions."}) {
    EXPECT_SAYS(refusal(path, text("D4")), "unknown key") << path;
  }
}

TEST(ScenarioKeys, lists_with_empty_or_repeated_texts_are_refused) {
  EXPECT_SAYS(refusal("template.columns", texts({})), "too short");
  EXPECT_SAYS(refusal("template.columns", texts({"A", ""})), "empty text");
  EXPECT_SAYS(refusal("template.rows", texts({"1", "2", "1"})), "\"1\" twice");
  EXPECT_EQ(refusal("template.columns", texts({"A", "a"})), "");
}

TEST(ScenarioValues, are_written_as_in_a_file) {
  EXPECT_EQ(to_string(number(0.1)), "0.1");
  EXPECT_EQ(to_string(number(200)), "200");
  EXPECT_EQ(to_string(truth(true)), "true");
  EXPECT_EQ(to_string(text("a\"b\\c\n")), "\"a\\\"b\\\\c\\u000A\"");
  EXPECT_EQ(to_string(numbers({1, -2.5})), "[1, -2.5]");
  EXPECT_EQ(to_string(texts({"A", "a"})), "[\"A\", \"a\"]");
}

/// A value written directly into a field, without set_scenario_key().
struct Written {
  std::string path;
  ScenarioValue value;
  std::function<void(Scenario&)> write;
};

/// Values that no key may have: too small, too large, not a number, an unknown word.
std::vector<Written> bad_fields() {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<Written> all;
  const auto number_field = [&](const char* path, double low, double high, auto field) {
    for (const double bad : {low, high, nan, infinite, -infinite})
      all.push_back({path, number(bad), [=](Scenario& s) { *field(s) = bad; }});
  };
  const auto whole_field = [&](const char* path, int low, int high, auto field) {
    for (const int bad : {low, high}) all.push_back({path, whole(bad), [=](Scenario& s) { *field(s) = bad; }});
  };
  const auto choice_field = [&](const char* path, auto field) {
    Scenario any;
    using E = std::decay_t<decltype(*field(any))>;
    for (const auto bad : {static_cast<E>(-1), static_cast<E>(Words<E>::all.size()), static_cast<E>(77)})
      all.push_back({path, text(word(bad)), [=](Scenario& s) { *field(s) = bad; }});
  };
  number_field("patient.scale", -1, 1e7, [](Scenario& s) { return &s.patient.scale; });
  whole_field("patient.volume", -1, 1000001, [](Scenario& s) { return &s.patient.volume; });
  choice_field("tissue.preset", [](Scenario& s) { return &s.tissue_model.preset; });
  choice_field("tissue.element", [](Scenario& s) { return &s.tissue_model.element; });
  number_field("tissue.creep", 0.9, 101, [](Scenario& s) { return &s.tissue_model.creep; });
  number_field("tissue.creep_s", 0.0, 1001, [](Scenario& s) { return &s.tissue_model.creep_s; });
  number_field("tissue.prostate.young_kPa", 0, 1e9, [](Scenario& s) { return &s.tissue["prostate"].young_kPa; });
  number_field("tissue.prostate.poisson", -0.1, 0.5, [](Scenario& s) { return &s.tissue["prostate"].poisson; });
  number_field("tissue.prostate.cutting_N", -1, 101, [](Scenario& s) { return &s.tissue["prostate"].cutting_N; });
  number_field("tissue.prostate.friction_viscous_to_mm_per_s", 0, 10001,
               [](Scenario& s) { return &s.tissue["prostate"].friction_viscous_to_mm_per_s; });
  choice_field("fixed.outer", [](Scenario& s) { return &s.fixed.outer; });
  all.push_back(
      {"fixed.box_mm", numbers({0, 0, 0, nan, 1, 1}), [=](Scenario& s) { s.fixed.box_mm = {0, 0, 0, nan, 1, 1}; }});
  whole_field("mesh.nodes", -1, 1000001, [](Scenario& s) { return &s.mesh.nodes; });
  choice_field("mesh.preset", [](Scenario& s) { return &s.mesh.preset; });
  number_field("mesh.cull_mm", -1, 6, [](Scenario& s) { return &s.mesh.cull_mm; });
  choice_field("needle.model", [](Scenario& s) { return &s.needle.model; });
  number_field("needle.length_mm", 19, 1001, [](Scenario& s) { return &s.needle.length_mm; });
  number_field("needle.diameter_mm", 0.1, 6, [](Scenario& s) { return &s.needle.diameter_mm; });
  number_field("needle.lumen_diameter_mm", -1, 6, [](Scenario& s) { return &s.needle.lumen_diameter_mm; });
  choice_field("needle.bevel_law", [](Scenario& s) { return &s.needle.bevel_law; });
  choice_field("coupling.method", [](Scenario& s) { return &s.coupling.method; });
  choice_field("coupling.rule", [](Scenario& s) { return &s.coupling.rule; });
  choice_field("coupling.solver", [](Scenario& s) { return &s.coupling.solver; });
  choice_field("coupling.engine", [](Scenario& s) { return &s.coupling.engine; });
  number_field("coupling.spacing_mm", -4, 1e6, [](Scenario& s) { return &s.coupling.spacing_mm; });
  number_field("insertion[0].speed_mm_per_s", 0, 1e6, [](Scenario& s) { return &s.insertions[0].speed_mm_per_s; });
  number_field("insertion[0].approach_mm", -1, 1e6, [](Scenario& s) { return &s.insertions[0].approach_mm; });
  number_field("insertion[0].depth_mm", -1, 1e6, [](Scenario& s) { return &s.insertions[0].depth_mm; });
  number_field("run.dt_ms", -1, 1e6, [](Scenario& s) { return &s.run.dt_ms; });
  return all;
}

TEST(CheckScenario, refuses_what_was_written_in_cpp_with_the_words_of_a_file) {
  for (const Written& bad : bad_fields()) {
    Scenario s = runnable();
    s.tissue["prostate"] = default_tissue("prostate");
    bad.write(s);
    const auto checked = check_scenario(s, [](const std::string& path) { return "at <" + path + ">"; });
    ASSERT_FALSE(checked) << bad.path << " = " << to_string(bad.value) << " was taken";
    Scenario other;
    const auto set = set_scenario_key(other, bad.path, bad.value, "somewhere");
    ASSERT_FALSE(set) << bad.path << " = " << to_string(bad.value);
    EXPECT_EQ(checked.error().where, "at <" + bad.path + ">");
    EXPECT_EQ(checked.error().what, set.error().what);
    EXPECT_EQ(checked.error().cure, set.error().cure);
  }
}

TEST(CheckScenario, takes_every_default_and_whatever_a_key_was_set_to) {
  Scenario s = runnable();
  for (const std::string& region : known_tissues()) s.tissue[region] = default_tissue(region);
  s.patient.regions["CTV"] = "prostate";
  EXPECT_EQ(complaint(s), "");
}

TEST(CheckScenario, takes_a_patient_and_a_hole) {
  EXPECT_EQ(complaint(runnable()), "");
  EXPECT_TRUE(check_scenario(runnable(), "case.toml").ok());
}

TEST(CheckScenario, wants_a_patient_and_a_needle) {
  Scenario s = runnable();
  s.patient.source.clear();
  EXPECT_SAYS(complaint(s), "at <patient.source>: there is no patient");
  s = runnable();
  s.insertions.clear();
  EXPECT_SAYS(complaint(s), "at <>: there is no needle: no [[insertion]]");
}

TEST(CheckScenario, wants_the_needles_way_given_once) {
  Scenario s = runnable();
  s.insertions[0].hole.reset();
  EXPECT_SAYS(complaint(s), "at <insertion[0]>: insertion[0] has neither hole nor entry_mm");
  s.insertions[0].entry_mm = {0, 0, -80};
  EXPECT_EQ(complaint(s), "");
  s.insertions[0].direction = {0, 0.1, 1};
  EXPECT_EQ(complaint(s), "");
  s.insertions[0].target_mm = {0, 0, 0};
  EXPECT_SAYS(complaint(s), "at <insertion[0].target_mm>: insertion[0] has both direction and target_mm");
  s.insertions[0].direction.reset();
  EXPECT_EQ(complaint(s), "");
  s.insertions[0].target_mm = s.insertions[0].entry_mm;
  EXPECT_SAYS(complaint(s), "the same point");
  s = runnable();
  s.insertions[0].entry_mm = {0, 0, -80};
  EXPECT_SAYS(complaint(s), "insertion[0] has both hole and entry_mm");
  s = runnable();
  s.insertions[0].target_mm = {0, 0, 0};
  EXPECT_SAYS(complaint(s), "insertion[0] has a hole and a target_mm");
  s = runnable();
  s.insertions.push_back(s.insertions[0]);
  s.insertions[1].hole.reset();
  s.insertions[1].entry_mm = {0, 0, -80};
  s.insertions[1].direction = {0, 0, 0};
  EXPECT_SAYS(complaint(s), "at <insertion[1].direction>: insertion[1].direction = [0, 0, 0] points nowhere");
}

TEST(CheckScenario, takes_a_recorded_motion_instead_of_all_else) {
  Scenario s = runnable();
  s.insertions[0].hole.reset();
  s.insertions[0].motion = "base.csv";
  EXPECT_EQ(complaint(s), "");
  s.insertions[0].hole = "D4";
  EXPECT_SAYS(complaint(s), "at <insertion[0].motion>: insertion[0] has a recorded motion and a hole");
}

TEST(CheckScenario, wants_a_hole_that_exists) {
  Scenario s = runnable();
  s.insertions[0].hole = "H9";
  const std::string message = complaint(s);
  EXPECT_SAYS(message, "at <insertion[0].hole>: insertion[0].hole = \"H9\"");
  EXPECT_SAYS(message, "columns are A … G, rows 1 … 7");
  EXPECT_SAYS(message, "for example D4");
}

TEST(CheckScenario, keeps_the_depth_within_the_needle) {
  Scenario s = runnable();
  s.insertions[0].depth_mm = 195;
  EXPECT_EQ(complaint(s), "");
  s.insertions[0].depth_mm = 195.5;
  const std::string message = complaint(s);
  EXPECT_SAYS(message, "at <insertion[0].depth_mm>: insertion[0].depth_mm = 195.5 is more than the needle's length");
  EXPECT_SAYS(message, "(195)");
}

TEST(CheckScenario, keeps_contacts_apart_by_a_diameter) {
  Scenario s = runnable();
  s.coupling.spacing_mm = 1.0;
  EXPECT_SAYS(complaint(s), "coupling.spacing_mm = 1 is less than needle.diameter_mm = 1.27");
}

TEST(CheckScenario, wants_linear_tetrahedra_where_their_stiffness_changes) {
  Scenario s = runnable();
  for (const char* element : {"nodal-pressure", "p2"}) {
    s.tissue_model.element = choice<ElementChoice>(element).value();
    for (const char* method : {"node-addition", "node-repositioning"}) {
      s.coupling.method = choice<CouplingSettings::Method>(method).value();
      s.coupling.engine = CouplingSettings::Engine::woodbury;
      EXPECT_SAYS(complaint(s),
                  "at <tissue.element>: coupling.method = \"" + std::string(method) + "\" needs linear tetrahedra");
      EXPECT_SAYS(complaint(s), "tissue.element = \"" + std::string(element) + "\"");
      EXPECT_SAYS(complaint(s), "Set tissue.element = \"p1\", or coupling.method = \"near-field\" or \"embedded\"");
    }
    s.coupling.method = CouplingSettings::Method::embedded;
    EXPECT_SAYS(complaint(s), "coupling.engine = \"woodbury\" needs linear tetrahedra");
    s.coupling.engine = CouplingSettings::Engine::condensed;
    EXPECT_EQ(complaint(s), "");
  }
}

TEST(CheckScenario, wants_sliding_friction_below_static) {
  Scenario s = runnable();
  s.tissue["prostate"] = default_tissue("prostate");
  s.tissue["prostate"].friction_static_N_per_m = 10;
  const std::string message = complaint(s);
  EXPECT_SAYS(message, "tissue.prostate.friction_coulomb_N_per_m = 45 N/m exceeds");
  EXPECT_SAYS(message, "friction_static_N_per_m = 10 N/m");
}

TEST(CheckScenario, wants_the_corners_of_a_box_in_order) {
  Scenario s = runnable();
  s.fixed.box_mm = {-1, -1, -1, 1, 1, 1};
  EXPECT_EQ(complaint(s), "");
  s.fixed.box_mm = {-1, 1, -1, 1, -1, 1};
  EXPECT_SAYS(complaint(s),
              "at <fixed.box_mm>: fixed.box_mm: the low corner's y = 1 is not below the high corner's y = -1");
}

TEST(TemplateGrid, has_thirteen_by_thirteen_holes_five_millimetres_apart_around_D4) {
  const TemplateGrid grid;
  std::set<std::array<double, 2>> places;
  for (const std::string& column : grid.columns) {
    for (const std::string& row : grid.rows) {
      const auto offset = grid.offset_mm(column + row);
      ASSERT_TRUE(offset.ok()) << column << row;
      places.insert(*offset);
    }
  }
  EXPECT_EQ(places.size(), 169U);
  EXPECT_EQ(*grid.offset_mm("D4"), (std::array<double, 2>{0, 0}));
  EXPECT_EQ(*grid.offset_mm("A1"), (std::array<double, 2>{-30, -30})) << "right and posterior";
  EXPECT_EQ(*grid.offset_mm("G7"), (std::array<double, 2>{30, 30})) << "left and anterior";
  EXPECT_EQ(*grid.offset_mm("d3.5"), (std::array<double, 2>{5, -5}));
  EXPECT_EQ(*grid.offset_mm("D4.0"), *grid.offset_mm("D4"));
}

TEST(TemplateGrid, tells_small_letters_from_capitals) {
  const TemplateGrid grid;
  EXPECT_EQ((*grid.offset_mm("d4"))[0] - (*grid.offset_mm("D4"))[0], 5.0);
}

TEST(TemplateGrid, refuses_holes_that_are_not_there) {
  const TemplateGrid grid;
  for (const char* hole : {"", "D", "4", "g4", "D8", "D4.25", "D 4", "4D", "D4x"}) {
    const auto offset = grid.offset_mm(hole);
    ASSERT_FALSE(offset.ok()) << hole;
    EXPECT_SAYS(offset.error().message(), std::string("'") + hole + "'");
  }
}

TEST(TemplateGrid, can_be_another_one) {
  TemplateGrid grid;
  grid.pitch_mm = 4.0;
  grid.columns = {"a", "ab", "b"};
  grid.rows = {"1", "2"};
  EXPECT_EQ(*grid.offset_mm("ab1"), (std::array<double, 2>{0, -2}));
  EXPECT_EQ(*grid.offset_mm("b2"), (std::array<double, 2>{4, 2}));
}

constexpr std::array kPresets{TissuePreset::typical, TissuePreset::firm, TissuePreset::soft, TissuePreset::linear};

TEST(DefaultTissue, is_given_for_every_region_with_its_source) {
  std::vector<std::string> regions = known_tissues();
  for (const char* region : {"ptv", "label_3", "something else"}) regions.emplace_back(region);
  for (const TissuePreset preset : kPresets) {
    for (const std::string& region : regions) {
      const TissueParameters t = default_tissue(region, preset);
      EXPECT_GT(t.young_kPa, 0) << region;
      EXPECT_TRUE(t.poisson > 0 && t.poisson < 0.5) << region;
      EXPECT_GT(t.cutting_N, 0) << region;
      EXPECT_GT(t.friction_static_N_per_m, t.friction_coulomb_N_per_m) << region;
      EXPECT_FALSE(t.source.empty()) << region;
    }
  }
}

TEST(DefaultTissue, tents_and_lags_within_what_is_plausible) {
  // For an 18 gauge needle: tenting of 3 to 20 mm before a surface breaks, a cutting lag of at most 5 mm.
  for (const TissuePreset preset : kPresets) {
    for (const std::string& region : known_tissues()) {
      const TissueParameters tissue = default_tissue(region, preset);
      if (tissue.young_kPa > 1e4) continue;  // bone
      const auto warnings = tenting_warnings(region, tissue, 1.27);
      EXPECT_TRUE(warnings.empty()) << word(preset) << ": " << warnings.front();
    }
  }
}

TEST(DefaultTissue, of_firm_and_soft_presets_has_other_moduli_and_the_same_forces) {
  const TissueParameters typical = default_tissue("prostate");
  const TissueParameters firm = default_tissue("prostate", TissuePreset::firm);
  const TissueParameters soft = default_tissue("prostate", TissuePreset::soft);
  EXPECT_GT(firm.young_kPa, typical.young_kPa);
  EXPECT_LT(soft.young_kPa, typical.young_kPa);
  EXPECT_EQ(firm.puncture_N, typical.puncture_N);
  EXPECT_EQ(soft.cutting_N, typical.cutting_N);
  EXPECT_EQ(default_tissue("pubic_arch", TissuePreset::soft), default_tissue("pubic_arch"));
}

TEST(DefaultTissue, of_the_linear_preset_neither_stiffens_nor_creeps) {
  Scenario s = runnable();
  EXPECT_GT(creep_of(s), 1.0);
  s.tissue_model.preset = TissuePreset::linear;
  EXPECT_EQ(creep_of(s), 1.0);
  for (const std::string& region : known_tissues()) EXPECT_EQ(tissue_of(s, region).stiffening, 0.0) << region;
  s.tissue_model.creep = 2.0;
  EXPECT_EQ(creep_of(s), 2.0);
}

TEST(DefaultTissue, takes_planning_volumes_and_labels_for_the_gland_and_the_unknown_for_the_body) {
  for (const char* region : {"ptv", "ctv", "gtv", "label_1"})
    EXPECT_EQ(default_tissue(region), default_tissue("prostate"));
  EXPECT_EQ(default_tissue("obturator"), default_tissue("body"));
}

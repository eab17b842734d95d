// SPDX-License-Identifier: GPL-3.0-or-later
#include "support.hpp"

using namespace stylet;
using namespace stylet::test;

namespace {

const std::string kHead = "[patient]\nsource = \"phantom\"\n";  // lines 1 and 2
const std::string kTail = "\n[[insertion]]\nhole = \"D4\"\n";

Result<Scenario> read(const std::string& content) {
  const Folder folder;
  return read_scenario(write_file(folder / "case.toml", content));
}

/// The message of the error for a file with this content; checks that it names the file.
std::string refused(const std::string& content) {
  const std::string message = refusal(read(content));
  expect_says(message, {"case.toml"});
  return message;
}

/// The message for a complete scenario with this line as its fourth line.
std::string refused_line_4(const std::string& table, const std::string& line) {
  const std::string message = refused(kHead + table + "\n" + line + kTail);
  expect_says(message, {"case.toml, line 4"});
  return message;
}

}  // namespace

TEST(ReadScenario, five_lines_are_enough) {
  const auto scenario = value_of(read(kHead + kTail));
  Scenario expected;
  expected.patient.source = "phantom";
  expected.insertions.resize(1);
  expected.insertions[0].hole = "D4";
  EXPECT_EQ(scenario, expected) << "all else is the default";
}

TEST(ReadScenario, takes_values_of_every_kind) {
  const auto scenario = value_of(read(R"(
name = "everything"
[patient]
source = "phantom"
scale = 1_000
[patient.regions]
1 = "peripheral_zone"
"GTV 1.5" = "prostate"
[tissue.prostate]
young_kPa = 3.5e1
[tissue."my.region"]
puncture_N = 0.25
[fixed]
regions = ["pubic_arch", 'band']
box_mm = [-1, -2, -3.5, 1, 2, 3.5]
[mesh]
nodes = 1234
stiff_band = false
[coupling]
rule = "paper"
[template]
centre_mm = [1.5, 2]
[[insertion]]
entry_mm = [1, 2, -80]
direction = [0, 0.1, 1]
[[insertion]]
hole = "d3.5"
depth_mm = 50
retract = false
)"));
  EXPECT_EQ(scenario.name, "everything");
  EXPECT_EQ(scenario.patient.scale, 1000);
  EXPECT_EQ(scenario.patient.regions,
            (std::map<std::string, std::string>{{"1", "peripheral_zone"}, {"GTV 1.5", "prostate"}}));
  EXPECT_EQ(scenario.tissue.at("prostate").young_kPa, 35);
  EXPECT_EQ(scenario.tissue.at("prostate").puncture_N, default_tissue("prostate").puncture_N);
  EXPECT_EQ(scenario.tissue.at("my.region").puncture_N, 0.25);
  EXPECT_EQ(scenario.fixed.regions, (std::vector<std::string>{"pubic_arch", "band"}));
  EXPECT_EQ((*scenario.fixed.box_mm)[2], -3.5);
  EXPECT_EQ(scenario.mesh.nodes, 1234);
  EXPECT_FALSE(scenario.mesh.stiff_band);
  EXPECT_EQ(scenario.coupling.rule, CouplingSettings::Rule::paper);
  EXPECT_EQ((*scenario.grid.centre_mm)[0], 1.5);
  ASSERT_EQ(scenario.insertions.size(), 2U);
  EXPECT_EQ((*scenario.insertions[0].direction)[1], 0.1);
  EXPECT_FALSE(scenario.insertions[1].retract);
  EXPECT_EQ(scenario.insertions[1].hole, "d3.5");
  EXPECT_EQ(scenario.insertions[1].depth_mm, 50);
}

TEST(ReadScenario, tables_may_be_written_inline) {
  const auto a = read(
      "[patient]\nsource = \"phantom\"\nregions = { 1 = \"peripheral_zone\", \"2\" = \"transition_zone\" }\n"
      "[tissue]\nprostate = { young_kPa = 20, poisson = 0.4 }" +
      kTail);
  const auto b = read(
      "[patient]\nsource = \"phantom\"\n[patient.regions]\n\"1\" = \"peripheral_zone\"\n2 = \"transition_zone\"\n"
      "[tissue.prostate]\nyoung_kPa = 20\npoisson = 0.4" +
      kTail);
  const auto c = read(
      "patient.source = \"phantom\"\npatient.regions.1 = \"peripheral_zone\"\npatient.regions.2 = \"transition_zone\"\n"
      "tissue.prostate.young_kPa = 20\ntissue.prostate.poisson = 0.4\ninsertion = [{ hole = \"D4\" }]");
  ASSERT_TRUE(a.ok()) << a.error().message();
  ASSERT_TRUE(b.ok()) << b.error().message();
  ASSERT_TRUE(c.ok()) << c.error().message();
  EXPECT_EQ(*a, *b);
  EXPECT_EQ(*a, *c);
}

TEST(ReadScenario, windows_line_ends_and_a_byte_order_mark_are_no_matter) {
  EXPECT_TRUE(read("\xEF\xBB\xBF[patient]\r\nsource = \"phantom\"\r\n[[insertion]]\r\nhole = \"D4\"\r\n").ok());
}

TEST(ReadScenario, relative_names_start_in_the_scenarios_folder) {
  const Folder folder;
  write_file(folder / "data/here", "");
  const auto file = write_file(folder / "scenarios/case.toml",
                               "[patient]\nsource = \"../data/case.dcm\"\n[[insertion]]\nmotion = \"hand.csv\"\n");
  const auto scenario = read_scenario(file);
  ASSERT_TRUE(scenario.ok()) << scenario.error().message();
  EXPECT_EQ(scenario->patient.source, (folder / "data/case.dcm").string());
  EXPECT_EQ(scenario->insertions[0].motion, (folder / "scenarios/hand.csv").string());
  // The paths are absolute even if the scenario's own path is relative.
  const auto relative = value_of(read_scenario(std::filesystem::relative(file)));
  EXPECT_EQ(relative.insertions[0].motion, (folder / "scenarios/hand.csv").string());
}

TEST(ReadScenario, absolute_names_and_the_phantom_stay) {
  const auto scenario = value_of(read("[patient]\nsource = \"/data/case.dcm\"" + kTail));
  EXPECT_EQ(scenario.patient.source, "/data/case.dcm");
  EXPECT_EQ(read(kHead + kTail)->patient.source, "phantom");
}

TEST(ReadScenario, refuses_what_is_no_scenario) {
  const Folder folder;
  expect_says(refusal(read_scenario(folder / "nowhere.toml")), {"nowhere.toml", "no such file", "scenarios/demo.toml"});
  expect_says(refusal(read_scenario(folder.path())), {folder.path().c_str(), "a folder", "Name a scenario"});
  expect_says(refusal(read_scenario(write_file(folder / "empty.toml", ""))), {"empty.toml", "empty", "--print-schema"});
  expect_says(refusal(read_scenario(write_file(folder / "b.toml", std::string("[patient]\n\0\1\2", 13)))),
              {"b.toml", "binary", "Name a scenario"});
  expect_says(refusal(read_scenario(write_file(folder / "case.nrrd", "NRRD0004\ntype: uchar\n"))),
              {"case.nrrd: this is an NRRD image", "a scenario (TOML) is expected", "source = \"case.nrrd\""});
  expect_says(refusal(read_scenario(write_file(folder / "c.toml", "{\"format\": \"stylet-contours\"}"))),
              {"c.toml: this is a JSON file"});
  expect_says(refusal(read_scenario(write_file(folder / "l.toml",
                                               "name = \"Pr\xFC"
                                               "fung\"\n"))),
              {"l.toml, line 1", "UTF-8"});
  expect_says(refusal(read_scenario(write_file(folder / "big.toml", std::string(2 << 20, '#')))),
              {"big.toml: 2097152 bytes are too many"});
}

TEST(ReadScenario, refuses_bad_toml_with_line_column_and_cure) {
  expect_says(refused(kHead + "\n[[insertion]]\nhole = D4\n"),
              {"case.toml, line 5, column 8: hole = D4: this is not valid TOML", "quotes (\"D4\")"});
  expect_says(refused("[needle]\nlength_mm = 1,5\n"),
              {"line 2", "length_mm = 1,5", "Write decimals with a point (0.5)"});
  expect_says(refused("name = \"demo\n"), {"line 1", "Close the text"});
  expect_says(refused("[needle]\nlength_mm =\n"), {"line 2", "Give the key a value"});
  expect_says(refused("[needle]\nlength_mm 150\n"), {"line 2", "Write key = value"});
  expect_says(refused("[needle\nlength_mm = 150\n"), {"line 1"});
  expect_says(refused("[mesh]\nnodes = 1\nnodes = 2\n"), {"line 3", "each key once"});
  expect_says(refused("[mesh]\nnodes = 1\n[mesh]\npreset = \"paper\"\n"), {"line 3"});
  expect_says(refused("[mesh]\nnodes = 99999999999999999999\n"), {"line 2"});
}

TEST(ReadScenario, refuses_what_word_processors_make_of_toml) {
  expect_says(refused("[[insertion]]\nhole = \u201CD4\u201D\n"),
              {"case.toml, line 2, column 8: \u201C is not a quotation mark of TOML", "straight quotation marks"});
  expect_says(refused("[needle]\nlength_mm\u00A0= 150\n"), {"line 2, column 10: there is a no-break space"});
  expect_says(refused("[needle]\nl\u00E4nge = 150\n"), {"line 2, column 2: the character \u00E4 stands outside"});
  expect_says(refused("[needle]\nl\xE4nge = 150\n"), {"line 2, column 2: this is not text in UTF-8"});
}

TEST(ReadScenario, refuses_what_the_parser_cannot_bear) {
  for (const char* text : {"[[[1]]]", "[&", "[.a]", "[[", "[", "a = [1,}", "a = 1e\"\u00A7\"", "inf=-00:10.['''1\u00A7",
                           "s = \"\"\"\\\n\u00A7\"\"\"", "s = \"\\\u00A7\"", "a = ]", "a = }", "a = {b = [1}",
                           "a =1979-05-27 0  # mm", "a = 1979-05-27 0]", "a\u00A7"}) {
    refused(text);
  }
}

TEST(ReadScenario, takes_toml_with_everything_in_it) {
  const std::string head = R"(# "quotes' [brackets}
name = """
many "lines", a \u00e9, \
  continued, [brackets}""\""""""
"patient" . source = '/phan\tom' # ]
fixed.regions = [ # one "per line"
  "pubic_arch", # [
  'b#[]{}', """c""",
]
[ tissue . "a.b" ]
young_kPa = +1_0.5e0
)";
  const auto scenario = value_of(read(head + "[[ insertion ]] # x\r\nhole = \"D4\"\r\n"));
  EXPECT_EQ(scenario.name, "many \"lines\", a \u00E9, continued, [brackets}\"\"\"\"\"");
  EXPECT_EQ(scenario.patient.source, "/phan\\tom");
  EXPECT_EQ(scenario.fixed.regions, (std::vector<std::string>{"pubic_arch", "b#[]{}", "c"}));
  EXPECT_EQ(scenario.tissue.at("a.b").young_kPa, 10.5);
  expect_says(refused(head + "[ [insertion] ]\nhole = \"D4\"\n"), {"case.toml, line 12, column 1", "[[insertion]]"});
}

TEST(ReadScenario, refuses_unknown_keys_with_the_nearest) {
  expect_says(refused_line_4("[needle]", "lenght_mm = 150"),
              {"unknown key needle.lenght_mm", "Did you mean needle.length_mm?"});
  expect_says(refused_line_4("[tissue.prostate]", "youngs_kPa = 30"),
              {"unknown key tissue.prostate.youngs_kPa", "tissue.prostate.young_kPa?"});
  expect_says(refused_line_4("[mesh]", "length_mm = 150"),
              {"unknown key mesh.length_mm", "Did you mean needle.length_mm?"});
  expect_says(refused("nam = \"x\"\n" + kHead + kTail), {"case.toml, line 1", "unknown key nam", "Did you mean name?"});
  expect_says(refused(kHead + kTail + "deph_mm = 3\n"),
              {"case.toml, line 6", "unknown key insertion[0].deph_mm", "insertion[0].depth_mm?"});
  expect_says(refused(kHead + kTail + kTail + "deph_mm = 3\n"), {"case.toml, line 9", "insertion[1].deph_mm"});
  expect_says(refused_line_4("[mesh]", "colour = 3"), {"unknown key mesh.colour", "stylet insert --print-schema"});
}

TEST(ReadScenario, refuses_unknown_tables_with_the_nearest_also_when_they_are_empty) {
  expect_says(refused(kHead + "[nedle]\n" + kTail),
              {"case.toml, line 3", "unknown table nedle", "Did you mean [needle]?"});
  expect_says(refused(kHead + "[tissues.prostate]\n" + kTail),
              {"line 3", "unknown table tissues", "Did you mean [tissue.REGION]?"});
  expect_says(refused(kHead + "[[insertions]]\n"),
              {"line 3", "unknown table insertions", "Did you mean [[insertion]]?"});
  expect_says(refused(kHead + "[surgeon]\n"),
              {"line 3", "unknown table surgeon", "The tables are [patient], ", "[tissue.REGION]", "[[insertion]]"});
  expect_says(refused(kHead + "[mesh.fine]\n"), {"line 3", "unknown table mesh.fine"});
}

TEST(ReadScenario, takes_keys_of_all_tissue_beside_those_of_one) {
  for (const char* text : {"[tissue]\nelement = \"p1\"\n[tissue.prostate]\nyoung_kPa = 35\n",
                           "[tissue.prostate]\nyoung_kPa = 35\n[tissue]\nelement = \"p1\"\n",
                           "tissue.element = \"p1\"\ntissue.prostate.young_kPa = 35\n",
                           "tissue = {element = \"p1\", prostate = {young_kPa = 35}}\n"}) {
    const auto scenario = value_of(read(text + kHead + "[[insertion]]\nhole = \"D4\"\n"));
    EXPECT_EQ(scenario.tissue_model.element, ElementChoice::p1);
    EXPECT_EQ(scenario.tissue.at("prostate").young_kPa, 35);
    EXPECT_EQ(scenario.tissue.size(), 1U);
  }
  expect_says(refused("[tissue.element]\nyoung_kPa = 35\n" + kHead),
              {"line 1", "tissue.element is a table, a value is expected", "below [tissue]"});
  expect_says(refused("[tissue]\nelement = \"p3\"\n" + kHead), {"line 2", "p3", "\"nodal-pressure\""});
  expect_says(refused("[tissue]\nelemnt = \"p1\"\n" + kHead), {"line 2", "elemnt"});
}

TEST(ReadScenario, refuses_tables_for_values_and_values_for_tables) {
  expect_says(refused(kHead + "[mesh.nodes]\n"),
              {"line 3", "mesh.nodes is a table, a value is expected", "nodes = 0 below [mesh]"});
  expect_says(refused("[name]\n" + kHead),
              {"line 1", "name is a table", "Write name = \"insertion\" before the first table"});
  expect_says(refused("mesh = 3\n" + kHead),
              {"line 1", "mesh = 3 is a value, a table is expected", "[mesh]", "nodes, preset"});
  expect_says(refused("[tissue]\nprostate = 30\n"),
              {"line 2", "tissue.prostate = 30 is a value", "[tissue.prostate]", "young_kPa"});
  expect_says(refused("tissue = 30\n"), {"line 1", "[tissue.REGION]", "young_kPa"});
  expect_says(refused("insertion = \"D4\"\n"), {"line 1", "insertion = \"D4\" is a value", "[[insertion]]"});
  expect_says(refused(kHead + "regions = \"prostate\"\n"),
              {"line 3", "patient.regions = \"prostate\" is a value", "[patient.regions]"});
}

TEST(ReadScenario, refuses_single_brackets_for_double_ones_and_the_reverse) {
  expect_says(refused(kHead + "[insertion]\nhole = \"D4\"\n"),
              {"line 3", "[insertion] is a single table", "Write [[insertion]]"});
  expect_says(refused(kHead + "[insertion.\"[99999999999999999999]\"]\nhole = \"D4\"\n"), {"line 3", "[[insertion]]"});
  expect_says(refused("[[mesh]]\nnodes = 3\n"), {"line 1", "[[mesh]] is a list of tables", "Write [mesh]"});
}

TEST(ReadScenario, refuses_values_of_another_type) {
  expect_says(refused_line_4("[needle]", "length_mm = \"150\""),
              {"needle.length_mm = \"150\" is not a number", "20 … 1000 mm"});
  expect_says(refused_line_4("[mesh]", "nodes = 570.5"), {"mesh.nodes = 570.5 is not a whole number"});
  expect_says(refused_line_4("[mesh]", "stiff_band = 1"), {"mesh.stiff_band = 1 is not true or false"});
  expect_says(refused_line_4("[mesh]", "preset = 1"), {"mesh.preset = 1 is not a text in quotes", "\"paper\""});
  expect_says(refused_line_4("[fixed]", "regions = \"pubic_arch\""), {"not a list of texts", "[\"pubic_arch\"]"});
  expect_says(refused_line_4("[fixed]", "box_mm = 3"), {"fixed.box_mm = 3 is not a list of numbers"});
  expect_says(refused_line_4("[fixed]", "box_mm = [1, \"2\"]"), {"fixed.box_mm is a list of numbers and texts mixed"});
  expect_says(refused_line_4("[fixed]", "box_mm = [[1, 2], [3, 4]]"), {"fixed.box_mm is a list of other values"});
  expect_says(refused_line_4("[mesh]", "nodes = 2024-02-29"), {"mesh.nodes is a date"});
  expect_says(refused_line_4("[patient.regions]", "1 = 2"), {"patient.regions.1 = 2 is not a text in quotes"});
}

TEST(ReadScenario, refuses_values_out_of_range) {
  expect_says(refused_line_4("[tissue.prostate]", "poisson = 0.5"),
              {"tissue.prostate.poisson = 0.5 is outside its range", "0 … 0.4999"});
  expect_says(refused_line_4("[needle]", "length_mm = nan"), {"needle.length_mm = nan is not finite", "20 … 1000 mm"});
  expect_says(refused_line_4("[needle]", "length_mm = 0.2"), {"needle.length_mm = 0.2 is outside its range", "mm"});
  expect_says(refused_line_4("[needle]", "length_mm = -inf"), {"needle.length_mm = -inf is not finite"});
  expect_says(refused_line_4("[fixed]", "box_mm = [1, 2, 3]"), {"fixed.box_mm = [1, 2, 3] is 3 numbers long, not 6"});
  expect_says(refused_line_4("[fixed]", "outer = \"side\""), {"fixed.outer = \"side\"", "did you mean \"sides\"?"});
  expect_says(refused_line_4("[coupling]", "method = \"near\""),
              {"coupling.method = \"near\" is not an allowed word", "\"near-field\", \"node-addition\""});
  expect_says(refused_line_4("[template]", "columns = []"), {"template.columns", "too short"});
}

TEST(ReadScenario, refuses_what_does_not_go_together_and_names_the_line) {
  expect_says(refused(kHead + "[coupling]\nmethod = \"node-repositioning\"\n[[insertion]]\nhole = \"D4\"\n"),
              {"coupling.method = \"node-repositioning\"", "\"condensed\"", "\"woodbury\" or \"bcs\""});
  expect_says(refused("[[insertion]]\nhole = \"D4\"\n"), {"case.toml: there is no patient", "source = \"phantom\""});
  expect_says(refused("[patient]\n[[insertion]]\nhole = \"D4\"\n"), {"case.toml, line 1: there is no patient"});
  expect_says(refused(kHead), {"case.toml: there is no needle", "[[insertion]]"});
  expect_says(refused(kHead + "[[insertion]]\n"), {"case.toml, line 3: insertion[0] has neither hole nor entry_mm"});
  expect_says(refused(kHead + kTail + "entry_mm = [0, 0, -80]\n"), {"line 5: insertion[0] has both hole and entry_mm"});
  expect_says(refused(kHead + kTail + "direction = [0, 0, 1]\n"), {"line 6: insertion[0] has a hole and a direction"});
  expect_says(refused(kHead + kTail + "motion = \"m.csv\"\n"),
              {"line 6: insertion[0] has a recorded motion and a hole"});
  expect_says(refused(kHead + "[[insertion]]\nhole = \"g4\"\n"),
              {"line 4: insertion[0].hole = \"g4\"", "columns are A … G", "for example D4"});
  expect_says(refused(kHead + "[[insertion]]\nhole = \"D4\"\ndepth_mm = 300\n"),
              {"line 5: insertion[0].depth_mm = 300", "(195)", "needle.length_mm"});
  expect_says(refused(kHead + "[tissue.body]\nfriction_static_N_per_m = 5\n" + kTail),
              {"line 3: tissue.body.friction_coulomb_N_per_m = 45 N/m exceeds friction_static_N_per_m = 5 N/m"});
  expect_says(refused(kHead + "[coupling]\nspacing_mm = 1\n" + kTail),
              {"line 4: coupling.spacing_mm = 1 is less than needle.diameter_mm = 1.27"});
}

TEST(ReadScenario, takes_the_needles_and_goals_of_a_plan) {
  const auto scenario = value_of(read(
      kHead +
      "[template]\ncentre_mm = [0, 5]\n[plan]\nstrength_U = 0.5\nbase_mm = 40\n[[plan.needle]]\nhole = \"D4\"\ntrain = "
      "\"S-1-S\"\n[[plan.needle]]\nat_mm = [10, 5]\nseeds_mm = [0, 10]\nstranded = true\n[[plan.goal]]\nstructure = "
      "\"prostate\"\nmetric = \"D90_percent\"\nbound = \">=100\"\n"));
  EXPECT_TRUE(scenario.plan.is_given());
  ASSERT_EQ(scenario.plan.needles.size(), 2U);
  EXPECT_EQ(scenario.plan.needles[0].train, "S-1-S");
  EXPECT_FALSE(scenario.plan.needles[0].stranded.has_value());
  EXPECT_EQ(scenario.plan.needles[1].seeds_mm, (std::vector<double>{0.0, 10.0}));
  EXPECT_TRUE(scenario.plan.needles[1].stranded.value_or(false));
  ASSERT_EQ(scenario.plan.goal_table.size(), 1U);
  EXPECT_EQ(scenario.plan.goal_table[0].bound, ">=100");
}

TEST(ReadScenario, refuses_a_plan_that_does_not_fit_together_and_names_the_line) {
  const std::string plan = kHead + "[plan]\nbase_mm = 40\nstrength_U = 0.5\n";
  const std::string needle = "[[plan.needle]]\nat_mm = [0, 5]\ntrain = \"S\"\n";
  ASSERT_TRUE(read(plan + needle).ok());
  expect_says(refused(plan + "file = \"plan.csv\"\n" + needle),
              {"case.toml, line 6: plan.file = ", "there are 1 [[plan.needle]]", "not as both"});
  expect_says(refused(kHead + "[plan]\n" + needle), {"line 3: ", "plan.base_mm is missing", "LPS z of the base plane"});
  expect_says(refused(plan + kTail), {"line 3: ", "belong to [[plan.needle]], and there is none"});
  expect_says(refused(plan + "[[plan.needle]]\ntrain = \"S\"\n"),
              {"line 6: plan.needle[0] has neither hole nor at_mm", "at_mm = [10, 5]"});
  expect_says(refused(plan + needle + "hole = \"D4\"\n"), {"line 6: plan.needle[0] has both hole and at_mm"});
  expect_says(refused(plan + "[[plan.needle]]\nat_mm = [0, 5]\n"),
              {"line 6: plan.needle[0] has neither train nor seeds_mm", "seeds_mm = [0, 10]"});
  expect_says(refused(plan + needle + "seeds_mm = [0]\n"), {"line 6: plan.needle[0] has both train and seeds_mm"});
  expect_says(refused(plan + needle + "[[plan.needle]]\nat_mm = [0, 5]\nseeds_mm = [10, 0]\n"),
              {"line 11", "plan.needle[1].seeds_mm = [10, 0] is not in ascending order"});
  const std::string in_hole = "[[plan.needle]]\nhole = \"D4\"\ntrain = \"S\"\n";
  expect_says(refused(plan + in_hole), {"line 7: plan.needle[0].hole = \"D4\"", "template.centre_mm", "at_mm instead"});
  const std::string centred = plan + "[template]\ncentre_mm = [0, 5]\n";
  expect_says(refused(centred + in_hole + in_hole),
              {"line 12: plan.needle[1].hole = \"D4\"", "plan.needle[0] as well"});
  expect_says(refused(centred + "[[plan.needle]]\nhole = \"Z4\"\ntrain = \"S\"\n"),
              {"line 9: plan.needle[0].hole = \"Z4\"", "for example D4"});
  expect_says(refused(plan + needle + "[[plan.goal]]\nstructure = \"prostate\"\nmetric = \"D90\"\nbound = \">1\"\n"),
              {"line 9: plan.goal[0]: 'D90' is not a figure", "D90_percent"});
  expect_says(
      refused(plan + needle + "[[plan.goal]]\nstructure = \"prostate\"\nmetric = \"D90_Gy\"\nbound = \"145\"\n"),
      {"line 9: plan.goal[0]: the bound '145' does not begin with > or <", ">=90"});
  expect_says(refused(plan + "[[plan.nedle]]\n"),
              {"line 6", "unknown table plan.nedle", "Did you mean [[plan.needle]]?"});
}

TEST(ReadScenario, puts_a_preset_under_what_is_given_wherever_it_stands) {
  const auto young_kPa = [](const Scenario& s) { return s.tissue.at("body").young_kPa; };
  const double typical = default_tissue("body").young_kPa;
  const TissueParameters firm = default_tissue("body", TissuePreset::firm);
  const std::string own = "[tissue.body]\ncutting_N = 0.7\n";
  const std::string given = "[tissue.body]\nyoung_kPa = " + to_string({.number = typical}) + "\n";
  const std::string preset = "[tissue]\npreset = \"firm\"\n";
  for (const std::string& text : {preset + own, own + preset}) {
    const auto scenario = value_of(parse_scenario(kHead + text + kTail, "case.toml"));
    EXPECT_EQ(young_kPa(scenario), firm.young_kPa);
    EXPECT_EQ(scenario.tissue.at("body").cutting_N, 0.7);
  }
  const std::vector<std::string> late{"tissue.preset=\"firm\""};
  const auto scenario = value_of(parse_scenario(kHead + given + kTail, "case.toml", late));
  EXPECT_EQ(young_kPa(scenario), typical) << "given, though it is the other preset's default";
  EXPECT_EQ(tissue_of(scenario, "prostate"), default_tissue("prostate", TissuePreset::firm));
}

TEST(ReadScenario, tells_the_first_of_several_mistakes) {
  expect_says(refused("[run]\ndt_ms = 0\n[mesh]\nnodes = -1\n"), {"line 2", "run.dt_ms = 0"});
}

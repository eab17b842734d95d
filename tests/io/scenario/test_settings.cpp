// SPDX-License-Identifier: GPL-3.0-or-later
#include "support.hpp"

using namespace stylet;
using namespace stylet::test;

namespace {

const std::string kOne = "[patient]\nsource = \"phantom\"\n[[insertion]]\nhole = \"D4\"\n";
const std::string kTwo = kOne + "[[insertion]]\nhole = \"d4\"\n";

Result<Scenario> with(const std::string& content, const std::vector<std::string>& settings) {
  const Folder folder;
  return read_scenario(write_file(folder / "case.toml", content), settings);
}

Scenario one_with(const std::vector<std::string>& settings) {
  const auto scenario = with(kOne, settings);
  if (!scenario) {
    ADD_FAILURE() << scenario.error().message();
    return {};
  }
  return *scenario;
}

std::string refused_setting(const std::string& setting, const std::string& content = kOne) {
  return refusal(with(content, {setting}));
}

}  // namespace

TEST(Settings, replace_what_the_file_says) {
  EXPECT_EQ(one_with({"needle.length_mm=150"}).needle.length_mm, 150);
  EXPECT_EQ(one_with({"insertion[0].hole=e3.5"}).insertions[0].hole, "e3.5");
  EXPECT_EQ(one_with({"mesh.stiff_band=false"}).mesh.stiff_band, false);
  EXPECT_EQ(one_with({" mesh.nodes = 900 "}).mesh.nodes, 900);
  EXPECT_EQ((*one_with({"fixed.box_mm=[-1,-1,-1, 1,1,1]"}).fixed.box_mm)[3], 1);
  EXPECT_EQ(one_with({"fixed.regions=[\"band\"]"}).fixed.regions, std::vector<std::string>{"band"});
}

TEST(Settings, are_applied_in_order) { EXPECT_EQ(one_with({"mesh.nodes=900", "mesh.nodes=950"}).mesh.nodes, 950); }

TEST(Settings, need_no_quotes_around_texts) {
  EXPECT_EQ(one_with({"coupling.rule=paper"}).coupling.rule, CouplingSettings::Rule::paper);
  EXPECT_EQ(one_with({"coupling.rule=\"paper\""}).coupling.rule, CouplingSettings::Rule::paper);
  EXPECT_EQ(one_with({"name=two words, and = # more"}).name, "two words, and = # more");
  EXPECT_EQ(one_with({"name=2024"}).name, "2024");
  EXPECT_EQ(one_with({"name=2024-02-29"}).name, "2024-02-29");
  EXPECT_EQ(one_with({"name="}).name, "");
}

TEST(Settings, may_leave_out_the_number_of_the_only_insertion) {
  EXPECT_EQ(one_with({"insertion.depth_mm=60"}).insertions[0].depth_mm, 60);
  const std::string message = refused_setting("insertion.depth_mm=60", kTwo);
  expect_says(message,
              {"--set insertion.depth_mm=60", "2 insertions", "insertion[0].depth_mm to insertion[1].depth_mm"});
  EXPECT_EQ(with(kTwo, {"insertion[1].depth_mm=60"})->insertions[1].depth_mm, 60);
}

TEST(Settings, can_add_an_insertion_but_leave_no_gap) {
  EXPECT_EQ(one_with({"insertion[1].hole=d4"}).insertions.size(), 2U);
  EXPECT_EQ(with("[patient]\nsource = \"phantom\"\n", {"insertion.hole=D4"})->insertions.size(), 1U);
  expect_says(refused_setting("insertion[2].hole=d4"),
              {"--set insertion[2].hole=d4", "there is no insertion[2]", "insertion[1] adds another"});
  expect_says(refused_setting("insertion[x].hole=d4"), {"there is no insertion[x]"});
  expect_says(refused_setting("insertion[99999999999999999999999].hole=d4"), {"there is no insertion["});
}

TEST(Settings, may_be_whole_tables) {
  const Scenario s = *with(kTwo, {"insertion[0]={ depth_mm = 40, speed_mm_per_s = 5 }"});
  ASSERT_EQ(s.insertions.size(), 2U);
  EXPECT_EQ(s.insertions[0].depth_mm, 40);
  EXPECT_EQ(s.insertions[0].speed_mm_per_s, 5);
  EXPECT_EQ(s.insertions[0].hole, "D4") << "the rest stays";
  EXPECT_EQ(with(kOne, {"insertion[1]={ hole = \"d4\" }"})->insertions.size(), 2U);
  refused_setting("insertion={ \"[99999999999999999999]\" = { hole = \"d4\" } }");
}

TEST(Settings, reach_regions_and_labels_with_any_name) {
  EXPECT_EQ(one_with({"tissue.prostate.young_kPa=30"}).tissue.at("prostate").young_kPa, 30);
  EXPECT_EQ(one_with({"tissue.\"a=b.c\".young_kPa=30"}).tissue.at("a=b.c").young_kPa, 30);
  EXPECT_EQ(one_with({"patient.regions.1=peripheral_zone"}).patient.regions.at("1"), "peripheral_zone");
  EXPECT_EQ(one_with({"patient.regions.GTV 1.5=prostate"}).patient.regions.at("GTV 1.5"), "prostate");
  EXPECT_EQ(one_with({"patient.regions={ 1 = \"body\", 2 = \"prostate\" }"}).patient.regions.size(), 2U);
  EXPECT_EQ(one_with({"tissue.band={ young_kPa = 7, poisson = 0.3 }"}).tissue.at("band").poisson, 0.3);
}

TEST(Settings, name_files_from_the_current_folder_or_else_from_the_scenarios) {
  const Folder folder;
  const auto file = write_file(folder / "case.toml", kOne);
  write_file(folder / "here/mask.nii", "x");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "here");
  const std::vector<std::string> there{"patient.source=mask.nii"};
  const std::vector<std::string> nowhere{"patient.source=contours.dcm"};
  const auto a = read_scenario(file, there);
  const auto b = read_scenario(file, nowhere);
  std::filesystem::current_path(before);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->patient.source, (folder / "here/mask.nii").string());
  EXPECT_EQ(b->patient.source, (folder / "contours.dcm").string());
  EXPECT_EQ(one_with({"patient.source=phantom"}).patient.source, "phantom");
}

TEST(Settings, are_checked_as_the_file_is) {
  expect_says(refused_setting("needle.lenght_mm=150"),
              {"--set needle.lenght_mm=150: unknown key", "Did you mean needle.length_mm?"});
  expect_says(refused_setting("needle.length_mm=2000"),
              {"--set needle.length_mm=2000", "outside its range", "20 … 1000 mm"});
  expect_says(refused_setting("needle.length_mm=long"), {"needle.length_mm = \"long\" is not a number"});
  expect_says(refused_setting("needle.length_mm=1,5"), {"needle.length_mm = \"1,5\" is not a number"});
  expect_says(refused_setting("mesh=3"), {"--set mesh=3", "a table is expected"});
  expect_says(refused_setting("fixed.box_mm=[1, \"2\"]"), {"fixed.box_mm", "list"});
  expect_says(refused_setting("insertion.hole=Z9"),
              {"--set insertion.hole=Z9: insertion[0].hole = \"Z9\"", "no such hole"});
  expect_says(refused_setting("insertion.depth_mm=500"), {"--set insertion.depth_mm=500: insertion[0].depth_mm = 500"});
}

TEST(Settings, without_key_or_value_are_refused) {
  expect_says(refused_setting("needle.length_mm"), {"--set needle.length_mm", "no '='", "--set key=value"});
  expect_says(refused_setting("=3"), {"--set =3", "no key"});
  expect_says(refused_setting(""), {"--set", "no '='"});
  expect_says(refused_setting("name=\x01"), {"--set name", "not printable text"});
  expect_says(refused_setting("name=Pr\xFC"
                              "f"),
              {"--set name", "UTF-8"});
  expect_says(refused_setting("..=3"), {"--set ..=3", "unknown key"});
  expect_says(refused_setting("[0].hole=3"), {"unknown key"});
  expect_says(refused_setting("insertion=3"), {"--set insertion=3"});
  expect_says(refused_setting("name=\"a\"\nmesh.nodes=3"), {"--set name", "not printable text"});
}

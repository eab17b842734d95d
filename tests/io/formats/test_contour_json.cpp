// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "stylet/io/contours_io.hpp"

using namespace stylet;
using namespace stylet::test;

namespace {

const char* const small = R"({"format": "stylet-contours", "version": 1, "units": "mm", "frame": "LPS",
 "structures": [{"name": "Prostate", "contours": [[[0,0,0],[10,0,0],[10,10,0]], [[0,0,5],[10,0,5],[10,10,5]]]}]})";

/// Reads `small` with one part of its text replaced.
Result<ContourSet> with(const std::string& from, const std::string& to) {
  const Folder folder;
  return read_contour_json(write_file(folder / "case.json", replaced(small, from, to)));
}

}  // namespace

TEST(ContourJson, what_is_written_comes_back_exactly) {
  const Folder folder;
  ContourSet set = two_organs();
  set.rois[0].name = "Prostate \"left\" \\ ß";
  ASSERT_TRUE(write_contour_json(set, folder / "case.json").ok());
  const auto back = value_of(read_contour_json(folder / "case.json"));
  EXPECT_EQ(largest_difference(set, back), 0.0);
  EXPECT_EQ(back.label, set.label);
  EXPECT_EQ(back.frame_of_reference, set.frame_of_reference);
  EXPECT_EQ(back.rois[1].type, "ORGAN");
  EXPECT_EQ(back.rois[1].colour, set.rois[1].colour);
  EXPECT_EQ(back.rois[1].number, 2);
  EXPECT_EQ(back.source, (folder / "case.json").string());
}

TEST(ContourJson, the_shortest_file_of_the_documentation_is_enough) {
  const Folder folder;
  const auto set = value_of(read_contour_json(write_file(folder / "case.json", small)));
  ASSERT_EQ(set.rois.size(), 1U);
  EXPECT_EQ(set.rois[0].contours.size(), 2U);
  EXPECT_EQ(set.rois[0].contours[1].points[2], Vec3(10, 10, 5));
}

TEST(ContourJson, a_repeated_first_point_is_dropped) {
  const auto set = value_of(with("[10,10,0]]", "[10,10,0],[0,0,0]]"));
  EXPECT_EQ(set.rois[0].contours[0].points.size(), 3U);
}

TEST(ContourJson, an_empty_structure_is_noted) {
  const auto set = value_of(with("\"structures\": [", "\"structures\": [{\"name\": \"PTV\", \"contours\": []}, "));
  EXPECT_EQ(set.rois.size(), 1U);
  ASSERT_EQ(set.passed_over.size(), 1U);
  EXPECT_EQ(set.passed_over[0].name, "PTV");
}

TEST(ContourJson, an_unknown_key_is_refused_with_the_nearest_name) {
  expect_refused(with("\"units\"", "\"unit\": 1, \"units\""), {"'unit'", "Did you mean 'units'"});
  expect_refused(with("\"contours\"", "\"contour\""), {"structure 1", "'contour'", "Did you mean 'contours'"});
}

TEST(ContourJson, units_and_frames_other_than_ours_are_refused_with_a_cure) {
  expect_refused(with("\"mm\"", "\"cm\""), {"'cm'", "millimetres"});
  expect_refused(with("\"LPS\"", "\"RAS\""), {"'RAS'", "negate x and y"});
}

TEST(ContourJson, missing_and_mistyped_values_are_refused_with_their_place) {
  expect_refused(with("\"units\": \"mm\", ", ""), {"'units' is missing"});
  expect_refused(with("\"version\": 1", "\"version\": 2"), {"version 2"});
  expect_refused(with("stylet-contours", "contours"), {"stylet-contours"});
  expect_refused(with("\"Prostate\"", "17"), {"structure 1", "'name' is number"});
  expect_refused(with("\"Prostate\"", "\" \""), {"structure 1", "name is empty"});
  expect_refused(with("\"contours\": [", "\"colour\": [1, 2], \"contours\": ["), {"'Prostate'", "colour"});
  expect_refused(with("[10,10,5]", "[10,10]"), {"'Prostate', contour 2, point 3", "three numbers"});
  expect_refused(with("[10,10,5]", "[10,\"a\",5]"), {"contour 2, point 3", "\"a\"", "not a finite number"});
  expect_refused(with("[10,10,5]", "[10,null,5]"), {"contour 2, point 3", "null"});
  expect_refused(with("[10,10,5]", "[10,NaN,5]"), {"not valid JSON", "line 2"});
  expect_refused(with("[10,10,5]", "[10,1e999,5]"), {"not valid JSON"});
  expect_refused(with("}]}", "}]"), {"not valid JSON"});
}

TEST(ContourJson, a_damaged_structure_is_refused_with_the_way_to_do_without_it_and_skipped_where_asked) {
  const Folder folder;
  const fs::path file =
      write_file(folder / "case.json",
                 replaced(small, "\"structures\": [", R"("structures": [{"name": "Rectum", "contours": [[[0,0]]]}, )"));
  expect_refused(read_contour_json(file), {"'Rectum'", "skip = [\"Rectum\"] below [patient]"});
  const std::vector<std::string> skip{"RECTUM"};
  const auto set = value_of(read_contour_json(file, skip));
  EXPECT_EQ(set.rois.size(), 1U);
  ASSERT_EQ(set.passed_over.size(), 1U);
  EXPECT_EQ(set.passed_over[0].name, "Rectum");
}

TEST(ContourJson, two_structures_of_one_name_are_refused) {
  expect_refused(with("\"structures\": [",
                      "\"structures\": [{\"name\": \"Prostate\", \"contours\": [[[0,0,0],[1,0,0],[0,1,0]]]}, "),
                 {"two structures", "'Prostate'"});
}

TEST(ContourJson, a_file_without_contours_is_refused) {
  expect_refused(with(R"([[[0,0,0],[10,0,0],[10,10,0]], [[0,0,5],[10,0,5],[10,10,5]]])", "[]"),
                 {"none of its structures"});
}

TEST(ContourJson, a_failed_write_leaves_nothing_and_keeps_what_was_there) {
  const Folder folder;
  ContourSet set = two_organs();
  write_file(folder / "case.json", "old");
  set.rois[1].contours[0].points[0].x() = NAN;
  const Result<> written = write_contour_json(set, folder / "case.json");
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(content_of(folder / "case.json"), "old");
  EXPECT_FALSE(write_contour_json(two_organs(), folder / "no/such/folder/case.json").ok());
  fs::create_directory(folder / "taken");
  EXPECT_FALSE(write_contour_json(two_organs(), folder / "taken").ok());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator{}), 2);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Tests as which regions structures and labels are used, which ones are left out, and that this is reported.
#include "made_anatomy.hpp"
#include "stylet/mesher/structures.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

using testing::set_of;

/// A structure with a contour, which is not meshed here.
Roi roi(const std::string& name, const std::string& type = "") {
  Roi r;
  r.name = name;
  r.type = type;
  r.contours = {testing::circle(Vec3::Zero(), 10)};
  return r;
}

StructureChoice chosen(const std::vector<Roi>& rois, const MeshOptions& options = {}) {
  auto choice = choose_structures(set_of(rois), options);
  EXPECT_TRUE(choice.ok()) << (choice.ok() ? "" : choice.error().message());
  return choice.ok() ? *choice : StructureChoice{};
}

std::string refusal(const std::vector<Roi>& rois, const MeshOptions& options) {
  const auto choice = choose_structures(set_of(rois), options);
  return choice.ok() ? "" : choice.error().message();
}

std::vector<std::string> regions(const StructureChoice& choice) {
  std::vector<std::string> all;
  for (const StructureUse& use : choice.uses) all.push_back(use.region);
  return all;
}

bool says(const StructureChoice& choice, const std::string& text) {
  return std::any_of(choice.notes.begin(), choice.notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

using Regions = std::vector<std::string>;

TEST(Structures, a_planning_volume_is_the_gland_where_none_is_drawn_and_this_is_said) {
  const StructureChoice choice = chosen({roi("PTV", "PTV"), roi("Bladder", "AVOIDANCE")});
  EXPECT_EQ(regions(choice), (Regions{"prostate", "bladder"}));
  EXPECT_TRUE(choice.has_target);
  EXPECT_TRUE(says(choice, "structure 'PTV' (type PTV) is taken as the gland, since no structure is named prostate"));
}

TEST(Structures, the_type_tells_a_planning_volume_whose_name_does_not) {
  const StructureChoice choice = chosen({roi("P+SV 76", "CTV"), roi("Rectum", "PTV")});
  EXPECT_EQ(regions(choice), (Regions{"prostate", "rectum"})) << "a name that is recognised counts more than a type";
  EXPECT_TRUE(says(choice, "'P+SV 76' (type CTV) is taken as the gland"));
}

TEST(Structures, a_structure_called_target_is_one) {
  for (const char* name : {"Target", "target", "TARGET_1", "Zielvolumen"})
    EXPECT_EQ(regions(chosen({roi(name)})), Regions{"prostate"}) << name;
}

TEST(Structures, the_likeliest_gland_is_preferred_and_the_others_are_left_out) {
  const StructureChoice choice = chosen({roi("GTV"), roi("PTV"), roi("Target"), roi("CTV 2"), roi("CTV")});
  EXPECT_EQ(regions(choice), (Regions{"", "", "", "", "prostate"}));
  EXPECT_TRUE(
      says(choice, "left out (planning volume, and 'CTV' is taken as the gland): 'GTV', 'PTV', 'Target', 'CTV 2'"));
  EXPECT_EQ(regions(chosen({roi("GTV"), roi("PTV"), roi("Target")})), (Regions{"", "", "prostate"}));
  EXPECT_EQ(regions(chosen({roi("GTV"), roi("PTV")})), (Regions{"", "prostate"}));
  EXPECT_TRUE(says(chosen({roi("GTV")}), "only a lesion"));
}

TEST(Structures, a_volume_named_after_the_gland_goes_before_others_of_any_kind) {
  EXPECT_EQ(regions(chosen({roi("CTV_LN", "CTV"), roi("PTV1_prostate", "PTV")})), (Regions{"", "prostate"}));
  EXPECT_EQ(regions(chosen({roi("CTV"), roi("CTVprostate")})), (Regions{"", "prostate"}));
}

TEST(Structures, volumes_of_nodes_and_boosts_stand_in_only_where_there_is_no_other) {
  for (const char* name : {"CTV_LN", "LN1", "CTV nodal", "PelvicNodes", "CTV-Boost", "CTV_prost_boost"})
    EXPECT_EQ(regions(chosen({roi(name, "CTV"), roi("GTV")})), (Regions{"", "prostate"})) << name;
  EXPECT_EQ(regions(chosen({roi("CTV_LN", "CTV"), roi("Prost boost", "CTV")})), (Regions{"", "prostate"}));
  EXPECT_EQ(regions(chosen({roi("CTV_LN", "CTV")})), Regions{"prostate"});
  EXPECT_EQ(regions(chosen({roi("PlanVol", "CTV"), roi("GTV")})), (Regions{"prostate", ""})) << "ln as a word only";
}

TEST(Structures, an_empty_planning_volume_is_no_gland) {
  Roi empty;
  empty.name = "CTV";
  ContourSet set = set_of({empty, roi("PTV")});
  set.passed_over = {{"PROS", "empty"}, {"needle A5", "only open curves or points"}};
  const auto choice = choose_structures(set, {});
  ASSERT_TRUE(choice.ok());
  EXPECT_EQ(regions(*choice), Regions{"prostate"});
  EXPECT_EQ(choice->empty.size(), 3U);
  EXPECT_TRUE(says(*choice, "structures are left out (empty): 'CTV', 'PROS'"));
  EXPECT_TRUE(says(*choice, "structure is left out (only open curves or points): 'needle A5'"));
}

TEST(Structures, planning_volumes_are_left_out_where_the_gland_is_drawn) {
  const StructureChoice choice = chosen({roi("Prostate", "CTV"), roi("PTV", "PTV"), roi("Boost", "GTV")});
  EXPECT_EQ(regions(choice), (Regions{"prostate", "", ""}));
  EXPECT_TRUE(says(choice, "left out (planning volume, and the gland is drawn): 'PTV', 'Boost'"));
}

TEST(Structures, of_type_external_is_the_body_under_any_name) {
  EXPECT_EQ(regions(chosen({roi("Prostate"), roi("Outer 3", "EXTERNAL")})), (Regions{"prostate", "body"}));
  EXPECT_EQ(regions(chosen({roi("Prostate"), roi("Outer 3", "EXTERNAL"), roi("BODY")})),
            (Regions{"prostate", "", "body"}));
}

TEST(Structures, naming_one_leaves_the_others_recognised) {
  MeshOptions options;
  options.regions = {{"my volume", "prostate"}};
  const StructureChoice choice =
      chosen({roi("my volume"), roi("Bladder"), roi("Rectum"), roi("X1"), roi("PTV"), roi("Prostate")}, options);
  EXPECT_EQ(regions(choice), (Regions{"prostate", "bladder", "rectum", "", "", ""}));
  EXPECT_TRUE(says(choice, "structure is left out (name not recognised): 'X1'"));
  EXPECT_TRUE(says(choice, "structure is left out (the region prostate is assigned to 'my volume'): 'Prostate'"));
  EXPECT_TRUE(says(choice, "'PTV'"));
}

TEST(Structures, naming_one_half_keeps_the_other) {
  MeshOptions options;
  options.regions = {{"PZ_left", "peripheral_zone"}};
  const StructureChoice choice = chosen({roi("PZ_left"), roi("PZ_right"), roi("PZ"), roi("L PZ")}, options);
  EXPECT_EQ(regions(choice), (Regions{"peripheral_zone", "peripheral_zone", "", ""}));
  EXPECT_TRUE(says(choice, "structure 'PZ_right' is taken as peripheral_zone together with 'PZ_left'"));
  EXPECT_TRUE(says(choice, "left out (the region peripheral_zone is assigned to 'PZ_left', 'PZ_right'): 'PZ', 'L PZ'"));
  options.regions = {{"hip", "femur_left"}};
  EXPECT_EQ(regions(chosen({roi("Prostate"), roi("hip"), roi("Femur_L")}, options)),
            (Regions{"prostate", "femur_left", ""}))
      << "another drawing of the same side";
}

TEST(Structures, names_are_found_whatever_their_case) {
  MeshOptions options;
  options.regions = {{"MY VOLUME", "target"}};
  options.skip = {"bladder"};
  const StructureChoice choice = chosen({roi("my volume"), roi("Bladder")}, options);
  EXPECT_EQ(regions(choice), (Regions{"prostate", ""}));
  EXPECT_TRUE(says(choice, "left out (named in [patient] skip): 'Bladder'"));
}

TEST(Structures, skipped_structures_are_no_target_either) {
  MeshOptions options;
  options.skip = {"CTV"};
  EXPECT_EQ(regions(chosen({roi("CTV"), roi("PTV")}, options)), (Regions{"", "prostate"}));
  options.skip = {"PTV", "CTV"};
  EXPECT_FALSE(chosen({roi("CTV"), roi("PTV")}, options).has_target);
}

TEST(Structures, a_name_to_skip_that_is_not_there_is_refused_with_the_nearest) {
  MeshOptions options;
  options.skip = {"Rektum"};
  EXPECT_NE(refusal({roi("Prostate"), roi("Rectum")}, options).find("Did you mean 'Rectum'?"), std::string::npos);
  options.skip = {"Rectum"};
  options.regions = {{"rectum", "bladder"}};
  EXPECT_NE(refusal({roi("Prostate"), roi("Rectum")}, options).find("patient.skip and in patient.regions"),
            std::string::npos);
}

TEST(Structures, an_empty_name_to_skip_is_refused) {
  MeshOptions options;
  options.skip = {""};
  EXPECT_NE(refusal({roi("Prostate"), roi("Rectum")}, options).find("patient.skip: there is no structure ''"),
            std::string::npos)
      << "it must not mean all of them";
}

TEST(Structures, what_the_paper_preset_leaves_out_is_said) {
  MeshOptions options;
  options.preset = MeshPreset::paper;
  const StructureChoice choice = chosen({roi("PZ"), roi("TZ"), roi("Bladder"), roi("Band")}, options);
  EXPECT_EQ(regions(choice), (Regions{"prostate", "prostate", "", "band"}));
  EXPECT_TRUE(says(choice, "the gland only): 'Bladder'"));
}

LabelImage named_mask(const std::map<int, std::string>& names) {
  LabelImage image = testing::two_zones();
  image.labels[0] = 3;
  image.labels[1] = 4;
  image.names = names;
  return image;
}

TEST(Structures, labels_are_skipped_by_name_or_number) {
  const LabelImage image = named_mask({{1, "PZ"}, {2, "TZ"}, {3, "Bladder"}});
  MeshOptions options;
  options.skip = {"BLADDER", "4"};
  const auto choice = choose_structures(image, options);
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_EQ(regions(*choice), (Regions{"peripheral_zone", "transition_zone", "", ""}));
  EXPECT_TRUE(says(*choice, "labels are left out (named in [patient] skip): 'Bladder', '4'"));
  options.skip = {"Blader"};
  const auto wrong = choose_structures(image, options);
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().message().find("Did you mean 'Bladder'?"), std::string::npos);
}

TEST(Structures, a_label_that_the_reader_has_skipped_is_said_to_be) {
  LabelImage image = testing::two_zones();
  image.names = {{1, "PZ"}, {2, "TZ"}, {3, "Urethra"}};
  MeshOptions options;
  options.skip = {"Urethra"};
  const auto choice = choose_structures(image, options);
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_TRUE(says(*choice, "label is left out (named in [patient] skip): 'Urethra'"));
  options.regions = {{"urethra", "urethra"}};
  const auto both = choose_structures(image, options);
  ASSERT_FALSE(both.ok());
  EXPECT_NE(both.error().message().find("patient.skip and in patient.regions"), std::string::npos);
}

TEST(Structures, naming_one_label_leaves_the_others_recognised) {
  MeshOptions options;
  options.regions = {{"1", "prostate"}};
  const auto choice = choose_structures(named_mask({{1, "blob"}, {2, "Bladder"}}), options);
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_EQ(regions(*choice), (Regions{"prostate", "bladder", "", ""}));
  EXPECT_TRUE(says(*choice, "left out (name not recognised): '3', '4'"));
}

TEST(Structures, labels_of_one_region_are_united_where_one_of_them_is_named) {
  MeshOptions options;
  options.regions = {{"1", "peripheral_zone"}};
  const auto choice =
      choose_structures(named_mask({{1, "PZ_left"}, {2, "PZ_right"}, {3, "PZ"}, {4, "Bladder"}}), options);
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_EQ(regions(*choice), (Regions{"peripheral_zone", "peripheral_zone", "peripheral_zone", "bladder"}));
  EXPECT_TRUE(says(*choice, "label 'PZ_right' is taken as peripheral_zone together with 'PZ_left'"));
}

TEST(Structures, a_label_called_target_is_the_gland) {
  const auto choice = choose_structures(named_mask({{1, "Target"}, {2, "Rectum"}}), {});
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_EQ(regions(*choice), (Regions{"prostate", "rectum", "label_3", "label_4"}));
  EXPECT_TRUE(says(*choice, "label 'Target' is taken as the gland"));
}

/// Fills a box with a label; to[a] is the first voxel beyond the box.
void fill(LabelImage& image, int label, const std::array<int, 3>& from, const std::array<int, 3>& to) {
  for (int k = from[2]; k < to[2]; ++k) {
    for (int j = from[1]; j < to[1]; ++j) {
      for (int i = from[0]; i < to[0]; ++i) {
        image.labels[(static_cast<std::size_t>(k) * image.size[1] + j) * image.size[0] + i] =
            static_cast<std::uint16_t>(label);
      }
    }
  }
}

TEST(Structures, a_planning_label_within_the_gland_is_part_of_it) {
  LabelImage image = testing::two_zones();
  fill(image, 3, {28, 32, 6}, {36, 46, 9});  // most of it is in the posterior zone
  fill(image, 5, {30, 36, 7}, {32, 40, 8});  // within the other planning volume
  fill(image, 4, {54, 20, 5}, {64, 40, 9});  // beside the gland
  image.names = {{1, "PZ"}, {2, "TZ"}, {3, "GTV"}, {4, "PTV"}, {5, "Target"}};
  const auto choice = choose_structures(image, {});
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_EQ(regions(*choice),
            (Regions{"peripheral_zone", "transition_zone", "peripheral_zone", "", "peripheral_zone"}));
  EXPECT_TRUE(says(*choice, "label 'GTV' is taken as part of peripheral_zone, in which it lies"));
  EXPECT_TRUE(says(*choice, "left out (planning volume, and the gland is drawn): 'PTV'"));
}

TEST(Structures, planning_labels_around_the_gland_stay_left_out) {
  LabelImage image = testing::two_zones();
  fill(image, 0, {0, 0, 0}, {64, 56, 14});
  fill(image, 3, {10, 10, 2}, {50, 46, 12});
  fill(image, 2, {14, 14, 3}, {46, 42, 11});
  fill(image, 1, {18, 18, 4}, {42, 38, 10});
  image.names = {{1, "Prostate"}, {2, "CTV"}, {3, "PTV"}};
  const auto choice = choose_structures(image, {});
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_EQ(regions(*choice), (Regions{"prostate", "", ""})) << "a margin is no part of the gland";
}

TEST(Structures, a_planning_label_within_the_one_taken_as_the_gland_is_part_of_it) {
  LabelImage image = testing::two_zones();
  for (std::uint16_t& label : image.labels) label = label == 0 ? 0 : 1;
  fill(image, 2, {28, 24, 6}, {36, 32, 9});
  image.names = {{1, "CTV"}, {2, "GTV"}};
  const auto choice = choose_structures(image, {});
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_EQ(regions(*choice), (Regions{"prostate", "prostate"}));
}

}  // namespace
}  // namespace stylet

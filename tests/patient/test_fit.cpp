// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a file is a patient for this program: each rule with a patient that breaks it and a neighbour that does not.
#include "stylet/geom/box_mesh.hpp"
#include "stylet/mesher/body_parts.hpp"
#include "stylet/patient/fit.hpp"
#include "stylet/phantom/phantom.hpp"

#include "mesher/made_anatomy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stylet {
namespace {

using testing::ellipsoid;

/// Rules that a set breaks, each with "!" if it refuses the patient.
std::vector<std::string> broken(const PatientInput& input, const FitOptions& options = {}) {
  std::vector<std::string> rules;
  for (const FitFinding& finding : judge_fit(input, options))
    rules.push_back(finding.rule + (finding.verdict == FitVerdict::refuse ? "!" : ""));
  return rules;
}

using Rules = std::vector<std::string>;

Roi sized(const std::string& name, double volume_cc, const Vec3& at = Vec3::Zero()) {
  const double r = std::cbrt(volume_cc * 1000.0 * 3.0 / (4.0 * std::numbers::pi));
  return ellipsoid(name, at, Vec3::Constant(r), r / 10.0);
}

Roi bladder(const Vec3& at = Vec3(0, -10, 48)) { return ellipsoid("Bladder", at, Vec3(35, 30, 26), 3); }
Roi rectum(const Vec3& at = Vec3(0, 33, 5)) { return ellipsoid("Rectum", at, Vec3(14, 14, 50), 3); }
Roi body(const Vec3& at = Vec3::Zero()) { return ellipsoid("Body", at, Vec3(170, 110, 140), 10); }

ContourSet pelvis(const std::string& gland, std::vector<Roi> more = {}) {
  std::vector<Roi> rois{sized(gland, 40), bladder(), rectum(), body()};
  rois.insert(rois.end(), more.begin(), more.end());
  return testing::set_of(rois);
}

FitOptions insisting(const std::string& name) {
  FitOptions options;
  options.names.regions[name] = "prostate";
  return options;
}

TEST(Fit, a_pelvis_with_a_named_or_guessed_gland_has_no_finding) {
  for (const char* gland : {"Prostate", "CTV", "PTV_7800", "Prostata"})
    EXPECT_EQ(broken(pelvis(gland)), Rules{}) << gland;
}

TEST(Fit, demo_patients_of_all_seeds_have_no_finding) {
  for (std::uint64_t seed = 0; seed <= 30; ++seed) {
    const double spacing = seed % 5 == 0 ? 2.5 : 5.0;
    EXPECT_EQ(broken(demo_patient({.seed = seed, .slice_spacing_mm = spacing})), Rules{}) << seed;
  }
}

TEST(Fit, a_gland_of_an_impossible_volume_is_refused_and_a_rare_one_is_warned_of) {
  const auto rules = [](double cc) { return broken(testing::set_of({sized("Prostate", cc)})); };
  EXPECT_EQ(rules(0.03), Rules{"gland_volume_possible!"});
  EXPECT_EQ(rules(1.8), Rules{"gland_volume_possible!"});
  EXPECT_EQ(rules(2.2), Rules{"gland_volume_usual"});
  EXPECT_EQ(rules(7.5), Rules{"gland_volume_usual"});
  EXPECT_EQ(rules(9), Rules{});
  EXPECT_EQ(rules(230), Rules{});
  EXPECT_EQ(rules(270), Rules{"gland_volume_usual"});
  EXPECT_EQ(rules(1600), Rules{"gland_volume_possible!"});
  EXPECT_EQ(rules(32000), Rules{"gland_volume_possible!"});
}

TEST(Fit, the_cure_of_a_wrong_unit_is_the_scale_where_a_file_can_have_one) {
  TetMesh mesh = box_mesh(Vec3(-3, -3, -3), Vec3(3, 3, 3), {12, 12, 12});
  assign_regions(mesh, {"prostate", "body"}, [](const Vec3& x) { return x.norm() < 1.9 ? 0 : 1; });
  const auto findings = judge_fit(PatientInput(mesh), {});
  const auto error = refusal(findings, "m.vtu");
  ASSERT_TRUE(error);
  EXPECT_NE(error->cure.find("patient.scale = 10 "), std::string::npos) << error->message();
  EXPECT_NE(refusal(judge_fit(PatientInput(mesh), {.scale = 2.0}), "m.vtu")->cure.find("patient.scale = 20 "),
            std::string::npos);
  const auto contours = refusal(judge_fit(testing::set_of({sized("Prostate", 32000)}), {}), "c.json");
  ASSERT_TRUE(contours);
  EXPECT_NE(contours->cure.find("0.1 times as long: write the file in mm"), std::string::npos) << contours->message();
}

TEST(Fit, a_target_beside_organs_from_elsewhere_is_refused) {
  for (const char* organ : {"Heart", "Lung_L", "LungLt", "Herz", "Lunge links", "Sein gauche", "Pulmón_D", "左肺", "脳",
                            "Печень", "Spinal Cord", "Eye_R", "Liver", "Femur_L", "BrainStem", "KidneyLeft"}) {
    EXPECT_EQ(broken(testing::set_of({sized("CTV", 30), sized(organ, 300, Vec3(90, 0, 0))})), Rules{"other_body_part!"})
        << organ;
    EXPECT_EQ(broken(testing::set_of({sized("CTV", 30), sized(organ, 300, Vec3(90, 0, 0))}), insisting("CTV")),
              Rules{"other_body_part"})
        << organ;
    EXPECT_EQ(broken(testing::set_of({sized("Prostate", 30), sized(organ, 300, Vec3(90, 0, 0))})),
              Rules{"other_body_part"})
        << organ;
    EXPECT_EQ(broken(pelvis("CTV", {sized(organ, 300, Vec3(0, 0, 400))})), Rules{}) << organ << " of a whole body";
  }
}

TEST(Fit, a_skipped_organ_still_says_what_the_file_is_of) {
  ContourSet set = testing::set_of({sized("CTV", 30), sized("Heart", 300, Vec3(90, 0, 0))});
  FitOptions options;
  options.names.skip = {"Heart"};
  EXPECT_EQ(broken(set, options), Rules{"other_body_part!"});
  set.rois[1].contours.clear();  // an empty structure of a template says nothing
  EXPECT_EQ(broken(set), Rules{});
}

TEST(Fit, organs_and_helpers_of_a_male_pelvis_are_not_from_elsewhere) {
  for (const char* name : {"Bladder neck", "Femoral neck", "Cord", "Spermatic cord", "Penile bulb", "Bowel", "Sigmoid",
                           "optBladder", "Seminal vesicles", "Rectum wall", "PTV rim", "Urethra", "Needle 1", "Point"})
    EXPECT_EQ(body_part(name), BodyPart::none) << name;
}

TEST(Fit, a_female_pelvis_is_refused_for_a_guessed_gland) {
  for (const char* organ : {"Uterus", "Cervix", "vagina", "Gebärmutter", "utérus", "子宮", "Матка", "Ovary_L"}) {
    EXPECT_EQ(broken(pelvis("CTV", {sized(organ, 50, Vec3(0, 0, 60))})), Rules{"female_pelvis!"}) << organ;
    EXPECT_EQ(broken(pelvis("Prostate", {sized(organ, 50, Vec3(0, 0, 60))})), Rules{"female_pelvis"}) << organ;
  }
}

TEST(Fit, a_gland_far_from_bladder_or_rectum_is_found) {
  const auto rules = [](const char* gland, double up) {
    return broken(testing::set_of({sized(gland, 30), bladder(Vec3(0, -10, up))}));
  };
  EXPECT_EQ(rules("CTV", 65), Rules{});
  EXPECT_EQ(rules("CTV", 100), Rules{"gland_near_organs!"});
  EXPECT_EQ(rules("Prostate", 100), Rules{"gland_near_organs"});
  EXPECT_EQ(broken(testing::set_of({sized("CTV", 30), rectum(Vec3(0, 90, 0))})), Rules{"gland_near_organs!"});
}

TEST(Fit, a_target_that_takes_in_an_organ_is_not_the_gland) {
  EXPECT_EQ(broken(testing::set_of({ellipsoid("CTV", Vec3::Zero(), Vec3(35, 35, 35), 3),
                                    ellipsoid("Rectum", Vec3(0, 5, 0), Vec3(14, 14, 30), 3)})),
            Rules{"organ_in_gland!"});
  EXPECT_EQ(broken(testing::set_of({ellipsoid("CTV", Vec3::Zero(), Vec3(25, 25, 25), 3),
                                    ellipsoid("Rectum", Vec3(0, 33, 0), Vec3(14, 14, 50), 3)})),
            Rules{});
}

TEST(Fit, a_gland_outside_of_the_body_is_refused) {
  const auto rules = [](double y) { return broken(testing::set_of({sized("Prostate", 40), body(Vec3(0, y, 0))})); };
  EXPECT_EQ(rules(0), Rules{});
  EXPECT_EQ(rules(80), Rules{});
  EXPECT_EQ(rules(160), Rules{"gland_in_body!"});
  EXPECT_EQ(rules(105), Rules{"gland_wholly_in_body"});
}

TEST(Fit, a_long_target_is_warned_of) {
  EXPECT_EQ(broken(testing::set_of({ellipsoid("CTV", Vec3::Zero(), Vec3(20, 18, 70), 4)})), Rules{"gland_length"});
}

TEST(Fit, a_urethra_elsewhere_is_warned_of) {
  EXPECT_EQ(broken(testing::set_of({sized("Prostate", 40), testing::tube("Urethra", Vec3(0, 0, -30), 60, 3, 3)})),
            Rules{});
  EXPECT_EQ(broken(testing::set_of({sized("Prostate", 40), testing::tube("Urethra", Vec3(50, 0, -30), 60, 3, 3)})),
            Rules{"urethra_in_gland"});
}

TEST(Fit, flipped_axes_and_exchanged_organs_are_warned_of) {
  const auto rules = [](const Vec3& of_bladder, const Vec3& of_rectum) {
    return broken(testing::set_of({sized("Prostate", 40), bladder(of_bladder), rectum(of_rectum)}));
  };
  EXPECT_EQ(rules(Vec3(0, -10, -48), Vec3(0, 33, -5)), Rules{"bladder_above_gland"});
  EXPECT_EQ(rules(Vec3(0, -15, 48), Vec3(0, -33, 5)), (Rules{"rectum_behind_gland", "bladder_before_rectum"}));
  ContourSet set = pelvis("Prostate");
  std::swap(set.rois[1].name, set.rois[2].name);
  const auto findings = judge_fit(set, {});
  ASSERT_FALSE(findings.empty());
  EXPECT_NE(findings.back().message().find("bladder and rectum are exchanged"), std::string::npos);
  EXPECT_EQ(
      broken(testing::set_of({sized("Prostate", 40), ellipsoid("Pubic arch", Vec3(0, 30, 10), Vec3(40, 10, 20), 3)})),
      Rules{"pubis_before_gland"});
  EXPECT_EQ(broken(pelvis("Prostate", {sized("Femur_L", 50, Vec3(-90, 0, 0)), sized("Femur_R", 50, Vec3(90, 0, 0))})),
            Rules{"left_and_right"});
  EXPECT_EQ(broken(pelvis("Prostate", {sized("Femur_L", 50, Vec3(90, 0, 0)), sized("Femur_R", 50, Vec3(-90, 0, 0))})),
            Rules{});
}

TEST(Fit, a_small_body_is_a_note_only) {
  const auto findings =
      judge_fit(testing::set_of({sized("Prostate", 30), ellipsoid("Body", Vec3::Zero(), Vec3(45, 45, 45), 5)}), {});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].verdict, FitVerdict::note);
  EXPECT_EQ(findings[0].rule, "body_width");
}

TEST(Fit, masks_and_meshes_are_judged_by_the_same_rules) {
  LabelImage image;
  image.size = {60, 60, 60};
  image.spacing = Vec3::Constant(2);
  image.labels.assign(60 * 60 * 60, 0);
  image.names = {{1, "CTV"}, {2, "Heart"}};
  std::size_t voxel = 0;
  for (int k = 0; k < 60; ++k) {
    for (int j = 0; j < 60; ++j) {
      for (int i = 0; i < 60; ++i, ++voxel) {
        if (Vec3(i - 15, j - 15, k - 15).norm() < 10) image.labels[voxel] = 1;
        if (Vec3(i - 40, j - 40, k - 40).norm() < 15) image.labels[voxel] = 2;
      }
    }
  }
  EXPECT_EQ(broken(image), Rules{"other_body_part!"});
  EXPECT_EQ(broken(image, insisting("1")), Rules{"other_body_part"});
  image.names[2] = "Bladder";
  EXPECT_EQ(broken(image), Rules{"gland_near_organs!"});
  image.names.clear();
  EXPECT_EQ(broken(image), Rules{}) << "labels without names";
  image.spacing = Vec3::Constant(0.2);
  EXPECT_EQ(broken(image), Rules{"gland_volume_possible"}) << "labels without names are never refused";

  TetMesh mesh = box_mesh(Vec3(-60, -60, -60), Vec3(60, 60, 60), {24, 24, 24});
  assign_regions(mesh, {"prostate", "gel"}, [](const Vec3& x) { return x.norm() < 20 ? 0 : 1; });
  EXPECT_EQ(broken(mesh), Rules{}) << "a sphere in a block";
  mesh.regions = {"ctv", "heart"};
  EXPECT_EQ(broken(mesh), Rules{"other_body_part!"});
  EXPECT_EQ(broken(mesh, insisting("ctv")), Rules{"other_body_part"});
  mesh.regions = {"sphere", "box"};
  EXPECT_EQ(broken(mesh), Rules{}) << "a mesh without a gland";
}

TEST(Fit, every_rule_is_in_the_documents_with_its_bound) {
  std::ifstream file(STYLET_FORMATS_PAGE);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  for (const FitRule& rule : fit_rules()) {
    EXPECT_NE(page.find(std::string("`") + rule.name + "`"), std::string::npos) << rule.name;
    EXPECT_NE(page.find(rule.bound), std::string::npos) << rule.name << ": " << rule.bound;
  }
}

}  // namespace
}  // namespace stylet

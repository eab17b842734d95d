// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

TEST(CanonicalRegion, usual_names_are_recognised_whatever_their_case_and_separators) {
  const std::vector<std::pair<std::string, std::string>> names{{"Prostate", "prostate"},
                                                               {"PROS", "prostate"},
                                                               {"prostate_gland", "prostate"},
                                                               {"Prostata", "prostate"},
                                                               {"PZ", "peripheral_zone"},
                                                               {"Peripheral Zone", "peripheral_zone"},
                                                               {"transition-zone", "transition_zone"},
                                                               {"CZ", "central_zone"},
                                                               {"AFS", "anterior_stroma"},
                                                               {"URETHRA", "urethra"},
                                                               {"Harnröhre", "urethra"},
                                                               {"Bladder", "bladder"},
                                                               {"Blase", "bladder"},
                                                               {"Rectum", "rectum"},
                                                               {"Rectal wall", "rectum"},
                                                               {"Pubic arch", "pubic_arch"},
                                                               {"pubis", "pubic_arch"},
                                                               {"Symphysis", "pubic_arch"},
                                                               {"BODY", "body"},
                                                               {"EXTERNAL", "body"},
                                                               {"Skin", "body"},
                                                               {"Seminal vesicles", "seminal_vesicles"},
                                                               {"Femoral Head Lt", "femur_left"},
                                                               {"Femoral Head RT", "femur_right"},
                                                               {"Femur_Head_L", "femur_left"},
                                                               {"R femur", "femur_right"},
                                                               {"PTV", "ptv"},
                                                               {"PTV_7800", "ptv"},
                                                               {"CTV 78 Gy", "ctv"},
                                                               {"GTV1", "gtv"},
                                                               {"Target", "target"},
                                                               {"Target volume 1", "target"}};
  for (const auto& [name, canonical] : names) EXPECT_EQ(canonical_region(name), canonical) << name;
}

TEST(CanonicalRegion, zones_are_recognised_as_people_write_them) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> names{
      {"peripheral_zone",
       {"peripheral", "PZ", "pz", "peripheral zone", "Peripheral_Zone", "PeripheralZone", "PZ_left", "L PZ", "PZ-R",
        "Prostate PZ", "prostatepz", "Left peripheral zone", "Peripheral zone of prostate", "peripheralzone_rt",
        "Structure of peripheral zone of prostate gland"}},
      {"transition_zone",
       {"transition", "Transition_Zone", "transitional", "TZ", "TZ_right", "transition zone of the prostate", "CG",
        "central gland", "TransitionZone"}},
      {"central_zone", {"central", "CZ", "Central zone", "central zone of prostate", "CZ_L"}},
      {"anterior_stroma",
       {"AFS", "afms", "anterior fibromuscular stroma", "Anterior_Fibromuscular_Stroma", "fibromuscular stroma",
        "Anterior fibromuscular stroma of prostate"}}};
  for (const auto& [canonical, written] : names) {
    for (const std::string& name : written) EXPECT_EQ(canonical_region(name), canonical) << name;
  }
  for (const std::string name :
       {"peripheral nerve", "central artery", "optPZ", "PZ lesion", "zone", "left", "of the"}) {
    EXPECT_EQ(canonical_region(name), "") << name;
  }
}

TEST(CanonicalRegion, a_canonical_name_is_its_own_synonym) {
  for (const std::string name : {"prostate", "peripheral_zone", "transition_zone", "central_zone", "anterior_stroma",
                                 "urethra", "bladder", "rectum", "pubic_arch", "femur_left", "femur_right", "band",
                                 "body", "seminal_vesicles", "ctv", "target", "ptv", "gtv"}) {
    EXPECT_EQ(canonical_region(name), name);
  }
}

TEST(CanonicalRegion, planning_helpers_and_channels_are_not_anatomy) {
  for (const std::string name :
       {"optBladder", "optRectum", "X1", "XApprox", "a5.5", "B4.5", "Prostate+5mm", "PTV-Rectum", "Vessels - left",
        "ring", "", "  ", "Rectum_in_PTV", "Femoral Head", "PTVboost"}) {
    EXPECT_EQ(canonical_region(name), "") << name;
  }
}

TEST(TargetRegion, gland_and_zones_and_planning_volumes_are_targets_and_organs_are_not) {
  for (const std::string name : {"prostate", "peripheral_zone", "transition_zone", "ctv", "target", "ptv", "gtv"}) {
    EXPECT_TRUE(is_target_region(name)) << name;
  }
  for (const std::string name : {"bladder", "urethra", "body", "band", ""})
    EXPECT_FALSE(is_target_region(name)) << name;
}

}  // namespace
}  // namespace stylet

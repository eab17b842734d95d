// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds that were found on images: files that can be read, and those that cannot be right.
#include "io/dose/dose_folder.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/found_seeds_io.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

class FoundSeedFiles : public testing_files::InFolder {
 protected:
  void expect_error(const std::string& text, const std::string& part) const {
    testing_files::expect_refused(read_found_seeds(file("found.csv", text)), part);
  }
  /// A plan with five seeds along z.
  static DosePlan row_of_seeds() {
    DosePlan plan;
    for (int k = 0; k < 5; ++k)
      plan.sources.push_back(
          {.at_mm = Vec3(0, 0, 10.0 * k), .axis = Vec3(0.6, 0, 0.8), .has_axis = true, .strength_U = 1});
    return plan;
  }
};

TEST_F(FoundSeedFiles, in_csv_have_places_and_axes_where_they_are_known) {
  const FoundSeeds found = read_found_seeds(file("found.csv",
                                                 "# frame_of_reference: 1.2.3\nz_mm,x_mm,y_mm,ax,ay,az,needle\n"
                                                 "3,1,2,0,3,4,D4\n\n6,4,5,,,,\n"))
                               .value();
  ASSERT_EQ(found.seeds.size(), 2U);
  EXPECT_EQ(found.seeds[0].at_mm, Vec3(1, 2, 3));
  EXPECT_LT((*found.seeds[0].axis - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_FALSE(found.seeds[1].axis);
  EXPECT_NE(found.seeds[1].where.find("found.csv, line 5"), std::string::npos);
  EXPECT_EQ(found.frame_of_reference, "1.2.3");
  EXPECT_TRUE(found.notes.empty());
}

TEST_F(FoundSeedFiles, can_be_the_plan_of_another_program) {
  const DosePlan plan = row_of_seeds();
  ASSERT_TRUE(write_plan_json(plan, folder / "found.json").ok());
  ASSERT_TRUE(write_rtplan(plan, find_source("i125_6711").value(), folder / "found.dcm").ok());
  for (const char* name : {"found.json", "found.dcm"}) {
    const FoundSeeds found = read_found_seeds(folder / name).value();
    ASSERT_EQ(found.seeds.size(), 5U) << name;
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_LT((found.seeds[k].at_mm - plan.sources[k].at_mm).norm(), 1e-6);
      EXPECT_LT((*found.seeds[k].axis - plan.sources[k].axis).norm(), 1e-6);
    }
    EXPECT_NE(found.seeds[2].where.find("seed 3"), std::string::npos);
  }
}

TEST_F(FoundSeedFiles, name_the_place_of_each_fault) {
  const std::string head = "x_mm,y_mm,z_mm\n";
  expect_error("", "empty");
  expect_error(head, "no rows");
  expect_error("x_mm,z_mm\n1,2\n", "y_mm is missing");
  expect_error("x_mm,y_mm,z_mm,ax\n1,2,3,1\n", "ay is missing");
  expect_error("x_mm,y_mm,z_cm\n1,2,3\n", "z_cm");
  expect_error(head + "1,2,3\n1,inf,3\n", "line 3, column y_mm: 'inf'");
  expect_error(head + "1,2,3\n1,2,\n", "line 3, column z_mm: ''");
  expect_error(head + "1,2,3e9\n", "line 2");
  expect_error("x_mm,y_mm,z_mm,ax,ay,az\n1,2,3,0,0,0\n", "line 2: the axis (0, 0, 0) has no length");
  DosePlan temporary = row_of_seeds();
  temporary.implant = Implant::temporary;
  for (PlannedSource& source : temporary.sources) source.dwell_s = 1.0;
  ASSERT_TRUE(write_plan_json(temporary, folder / "temporary.json").ok());
  testing_files::expect_refused(read_found_seeds(folder / "temporary.json"), "temporary implant");
}

TEST_F(FoundSeedFiles, that_have_a_seed_twice_say_so) {
  const FoundSeeds found = read_found_seeds(file("found.csv", "x_mm,y_mm,z_mm\n1,2,3\n4,5,6\n1,2,3.1\n")).value();
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("line 4"), std::string::npos);
  EXPECT_NE(found.notes[0].find("line 2"), std::string::npos);
}

TEST_F(FoundSeedFiles, of_another_frame_or_implant_are_refused_and_single_seeds_far_off_are_not) {
  const DosePlan plan = row_of_seeds();
  FoundSeeds found{.file = "found.csv", .frame_of_reference = "", .seeds = {}, .notes = {}};
  for (int k = 0; k < 5; ++k)
    found.seeds.push_back(
        {.at_mm = Vec3(3, 0, 10.0 * k), .axis = {}, .where = "found.csv, line " + std::to_string(k + 2)});
  EXPECT_TRUE(check_found_seeds(found, plan).ok());
  found.seeds[1].at_mm.y() = 600.0;  // a seed in the lung
  EXPECT_TRUE(check_found_seeds(found, plan).ok());
  found.seeds[1].at_mm.y() = 1600.0;
  testing_files::expect_refused(check_found_seeds(found, plan),
                                "line 3: the seed at (3.0, 1600.0, 10.0) mm is 1600 mm away");
  for (std::size_t k = 1; k < 4; ++k) found.seeds[k].at_mm = Vec3(0, -80, 0);
  testing_files::expect_refused(check_found_seeds(found, plan), "3 of 5 seeds are further than 30 mm");
  found.seeds.assign(11, {.at_mm = Vec3::Zero(), .axis = {}, .where = "found.csv"});
  testing_files::expect_refused(check_found_seeds(found, plan), "11 seeds were found, and 5 are planned");
}

}  // namespace
}  // namespace stylet

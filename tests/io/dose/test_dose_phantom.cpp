// SPDX-License-Identifier: GPL-3.0-or-later
// An HDR plan of a phantom with its structures and its dose by a planning system (Kennedy et al. 2023, Phys Eng Sci Med
// 46:1115). The data are not part of the repository; without them the tests are skipped.
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/patient/dose_structures.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

namespace stylet {
namespace {

namespace fs = std::filesystem;

class DosePhantom : public testing::Test {
 protected:
  void SetUp() override {
    const char* chosen = std::getenv("STYLET_SHARED_DATA");
    folder = fs::path(chosen != nullptr ? chosen : STYLET_SHARED_DATA_DEFAULT) / "robustbrachy_hdr_phantom";
    if (!fs::exists(folder / "PL001.dcm")) GTEST_SKIP() << folder << " is not there";
  }
  fs::path folder;
};

TEST_F(DosePhantom, has_the_dwell_positions_and_the_prescription_of_its_plan) {
  const DosePlan plan = read_plan(folder / "PL001.dcm").value();
  EXPECT_EQ(plan.implant, Implant::temporary);
  EXPECT_EQ(plan.prescription_Gy, 16.0);
  std::set<std::string> needles;
  for (const PlannedSource& s : plan.sources) {
    needles.insert(s.needle);
    EXPECT_TRUE(s.has_axis);
  }
  EXPECT_EQ(needles.size(), 14U);
  EXPECT_GT(plan.sources.size(), 100U);
  EXPECT_LE(plan.sources.size(), 144U);
}

// The frames of the file's dose lie 1 mm lower in z than its header says; this was found with an independent program.
TEST_F(DosePhantom, has_the_dose_of_the_planning_system) {
  const DosePlan plan = read_plan(folder / "PL001.dcm").value();
  const SourceModel source = find_source("ir192_gammamed_plus").value();
  const DoseStructures structures = dose_structures(read_input(folder / "SS001.dcm").value(), {}).value();
  DoseEvaluation e = evaluate_dose(plan, source, structures.structures, {}).value();
  const DoseGrid grid = read_rtdose(folder / "DO001.dcm").value();
  ASSERT_TRUE(compare_with_grid(e, grid, structures.structures, {}, Vec3(0, 0, -1)).ok());
  EXPECT_NEAR(e.comparison->median_ratio, 1.0, 0.001);
  EXPECT_NEAR(e.comparison->p1, 1.0, 0.005);
  EXPECT_NEAR(e.comparison->p99, 1.0, 0.005);
  EXPECT_GT(e.comparison->points, 10000U);
}

}  // namespace
}  // namespace stylet

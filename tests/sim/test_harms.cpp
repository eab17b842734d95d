// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_patient.hpp"
#include "stylet/sim/harms.hpp"

#include <algorithm>

using namespace stylet;
using namespace stylet::test;

TEST(Harms, are_entries_into_rectum_bladder_and_urethra_and_nothing_else) {
  std::vector<Event> events;
  for (const char* region : {"body", "prostate", "urethra", "pubic_arch", "bladder", "rectum"}) {
    events.push_back({EventKind::puncture, 1.0, 20.0, 1.0, region});
    events.push_back({EventKind::region_entered, 1.0, 20.0 + static_cast<double>(events.size()), 1.0, region});
  }
  const auto told = harms(events);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0], "The needle entered the urethra, at a depth of 25.0 mm.");
  EXPECT_SAYS(told[1], "bladder");
  EXPECT_SAYS(told[2], "rectum");
}

TEST(Harms, are_among_the_warnings_of_a_run) {
  TetMesh mesh = box_patient(false);
  mesh.regions[1] = "rectum";  // instead of the gland
  Scenario s = box_scenario();
  s.insertions[0].depth_mm = 35.0;
  const Finished run(compiled(s, mesh));
  const auto& warnings = run.summary.warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                          [](const std::string& w) { return contains(w, "The needle entered the rectum"); }));
  const Finished spared(compiled(box_scenario()));
  for (const std::string& w : spared.summary.warnings) EXPECT_FALSE(contains(w, "entered the")) << w;
}

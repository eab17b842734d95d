// SPDX-License-Identifier: GPL-3.0-or-later
// Properties that have to hold however long a session lasts.
#include "needle_in_block.hpp"
#include "support/count_allocations.hpp"

using namespace stylet;
using namespace stylet::test;
using Kind = EventKind;

TEST(Step, neither_takes_nor_gives_back_memory_in_a_hundred_thousand) {
  if (!AllocationCount::available()) GTEST_SKIP() << "the memory functions cannot be replaced under sanitizers";
  NeedleInBlock run;
  // In and out many times, each time beside the last place, and every eighth time into the last track: more tracks than
  // there is room for.
  constexpr double kDeep_mm = 40.0, kOut_mm = -2.0, kWay_mm = 0.08;
  constexpr int kSteps = 100'000;
  int insertions = 0, places = 0;
  const auto next = [&] {
    if (insertions++ % 8 != 7) ++places;
    run.point = {-14.0 + 3.5 * (places % 9), -15.0 + 3.5 * (places / 9 % 9), 0.0};
  };
  run.aim({3, 2, 0});
  next();
  int punctures = 0, withdrawn = 0, most_contacts = 0;
  long heap_calls = 0;
  unsigned flags = 0;
  double way = kWay_mm;
  for (int k = 0; k < kSteps; ++k) {
    run.depth += way;
    if (run.depth > kDeep_mm) way = -kWay_mm;
    if (run.depth < kOut_mm) {
      way = kWay_mm;
      next();
    }
    const Pose pose = run.pose();
    run.insertion->prepare(8.0);
    const AllocationCount counter;
    const Step report = run.insertion->step(pose, 1e-3);
    heap_calls += counter.count();
    flags |= report.flags & ~Step::too_fast;  // sideways, in the air
    most_contacts = std::max(most_contacts, report.contacts);
    for (const InsertionEvent& event : run.insertion->events()) {
      punctures += event.kind == Kind::puncture && event.region == 0 ? 1 : 0;
      withdrawn += event.kind == Kind::withdrawn ? 1 : 0;
    }
  }
  EXPECT_EQ(heap_calls, 0);
  EXPECT_EQ(flags, 0u);
  EXPECT_GE(withdrawn, insertions - 1);
  EXPECT_EQ(punctures, places);
  EXPECT_GT(punctures, 64);
  EXPECT_GT(most_contacts, 7);
}

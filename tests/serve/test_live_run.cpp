// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a run while nothing moves.
#include "live_run.hpp"
#include "serving.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <numeric>
#include <thread>

using namespace stylet;
using namespace stylet::serve;
using namespace stylet::test;

namespace {

/// A run whose needle was pushed into the box and is paused.
struct Paused {
  ProcessFolder folder;
  OpenModel open;
  std::shared_ptr<const DisplayField> field;
  std::unique_ptr<LiveRun> run;

  explicit Paused(bool with_field, const Scenario& scenario = hole_scenario()) {
    open.model = compiled(scenario);
    open.points.nodes.resize(static_cast<std::size_t>(open.model->mesh().node_count()));
    std::iota(open.points.nodes.begin(), open.points.nodes.end(), Index{0});
    field = value_of(DisplayField::prepare(open.model));
    if (with_field) open.field = field;
    RunnerSettings settings;
    settings.period_s = 4e-3;
    settings.late_after_s = 0.5;
    settings.realtime_scheduling = false;
    settings.lock_memory = false;
    run = value_of(LiveRun::start(open, 0, folder.path, settings, 10.0, nullptr));
    HandTarget hand;
    hand.depth_mm = 20.0;
    hand.speed_mm_per_s = 100.0;
    run->hand()->aim(hand);
    until([](const LiveFrame& frame) { return frame.step.base_depth_mm > 19.9; });
    run->runner().pause();
    until([](const LiveFrame& frame) { return (frame.bits & LiveFrame::paused) != 0; });
  }

  std::shared_ptr<const LiveFrame> next(bool whole_curve = false) const {
    run->pump([](const Event&) {});
    return run->picture(whole_curve);
  }
  /// The first picture that satisfies `good`.
  std::shared_ptr<const LiveFrame> until(const std::function<bool(const LiveFrame&)>& good) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
      if (auto frame = next(); frame && good(*frame)) return frame;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    throw std::runtime_error("waited in vain for a picture");
  }
};

double largest_mm(const LiveFrame& frame) {
  double most = 0.0;
  for (const std::int16_t u : frame.displacement) most = std::max(most, std::abs(u * frame.unit_mm));
  return most;
}

}  // namespace

TEST(LiveRun, a_field_that_comes_during_a_pause_is_shown_at_once) {
  const Paused paused(false);
  ASSERT_FALSE(paused.next()) << "nothing new";
  paused.run->set_field(paused.field);
  const auto frame = paused.next();
  ASSERT_TRUE(frame);
  EXPECT_GT(largest_mm(*frame), 0.01);
  EXPECT_NE(frame->bits & LiveFrame::paused, 0U);
  EXPECT_FALSE(paused.next()) << "once";
}

TEST(LiveRun, everybody_who_joins_during_a_pause_is_shown_the_displacement) {
  const Paused paused(true);
  for (int k = 0; k < 5; ++k) {
    const auto frame = paused.next(true);
    ASSERT_TRUE(frame);
    ASSERT_FALSE(frame->displacement.empty()) << "the one that came as number " << k;
    EXPECT_GT(largest_mm(*frame), 0.01);
  }
}

TEST(LiveRun, a_picture_has_the_tip_error_of_the_loop) {
  const Paused paused(false);
  const auto frame = paused.next(true);
  ASSERT_TRUE(frame);
  const auto& error = paused.run->runner().snapshot().tip_error;
  ASSERT_TRUE(error && frame->tip_error);
  EXPECT_EQ(frame->tip_error->mm, error->mm);
  EXPECT_EQ(frame->tip_error->base_depth_mm, frame->step.base_depth_mm) << "the needle is deepest";
  EXPECT_LT(error->mm.z(), -0.05) << "the tissue before the tip has given way";
}

TEST(LiveRun, a_picture_has_the_needles_that_stay_and_what_they_move) {
  Scenario scenario = hole_scenario();
  scenario.procedure.stabilising = {"C3"};
  const Paused paused(true, scenario);
  const auto frame = paused.next(true);
  ASSERT_TRUE(frame);
  ASSERT_EQ(frame->resting.size(), 3 * Snapshot::kRestingPoints);
  const PlannedInsertion& stays = paused.open.model->staying().front();
  EXPECT_NEAR(frame->resting.back(), stays.entry.z() + stays.depth_mm, 3.0);
  EXPECT_EQ(frame->left_out_N, 0.0) << "the displacement field covers the needle that stays";
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay.hpp"
#include "replayed_seeds.hpp"
#include "seed_journal.hpp"

#include "stylet/coupling/insertion.hpp"

#include <gtest/gtest.h>

#include <tuple>

using namespace stylet;
using namespace stylet::serve;

namespace {

/// A recording of four nodes, with ten steps of 0.1 s and frames at 0 and 1 s, between which everything moves
/// uniformly.
RunRecording recording() {
  RunRecording run;
  run.mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 1; k <= 10; ++k) {
    Step step;
    step.time_s = 0.1 * k;
    step.base_depth_mm = k;
    step.force_axial_N = 0.5 * k;
    run.steps.push_back(step);
  }
  for (const double t : {0.0, 1.0}) {
    Frame frame;
    frame.time_s = t;
    frame.displacement = VecX::Constant(12, t);
    frame.needle = {{0, 0, t}, {0, 0, 10.0 + t}};
    run.frames.push_back(frame);
  }
  return run;
}

double moved(const LiveFrame& frame, std::size_t k) { return frame.displacement[k] * frame.unit_mm; }

}  // namespace

TEST(Replay, shows_any_moment_between_its_frames) {
  Replay replay(recording(), {{3, 1}, {}});
  replay.seek(0.45);
  const auto frame = replay.picture(false);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->time_s, 0.45);
  EXPECT_EQ(frame->step.base_depth_mm, 4.0) << "of the step before";
  EXPECT_EQ(frame->step.force_axial_N, 2.0);
  ASSERT_EQ(frame->displacement.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(moved(*frame, k), 0.45, 1e-3);
  ASSERT_EQ(frame->centreline.size(), 6u);
  EXPECT_NEAR(frame->centreline[5], 10.45, 1e-6);
  EXPECT_TRUE(frame->bits & LiveFrame::replayed);
  EXPECT_EQ(replay.picture(false), nullptr) << "nothing new";
}

TEST(Replay, plays_to_its_end_and_stands_there) {
  Replay replay(recording(), {{0}, {}});
  replay.play(2.0);
  replay.advance(0.2);
  EXPECT_NEAR(replay.time_s(), 0.4, 1e-12);
  replay.advance(5.0);
  EXPECT_EQ(replay.time_s(), 1.0);
  EXPECT_EQ(replay.rate(), 0.0);
  replay.play(1.0);  // once more from the start
  EXPECT_EQ(replay.time_s(), 0.0);
}

TEST(Replay, stays_within_the_recording) {
  Replay replay(recording(), {{0}, {}});
  replay.seek(-3.0);
  EXPECT_EQ(replay.time_s(), 0.0);
  const auto before = replay.picture(false);
  EXPECT_EQ(before->steps, 0u);
  EXPECT_EQ(before->step.tip_mm.z(), 10.0) << "the needle's end, though there was no step yet";
  replay.seek(99.0);
  EXPECT_EQ(replay.time_s(), 1.0);
  EXPECT_EQ(replay.picture(false)->steps, 10u);
}

TEST(Replay, has_the_needle_where_the_first_step_had_it_before_that_step) {
  RunRecording late = recording();
  for (Step& step : late.steps) step.base_depth_mm -= 30.0;
  Replay replay(late, {{0}, {}});
  const auto frame = replay.picture(true);
  EXPECT_EQ(frame->time_s, 0.0);
  EXPECT_EQ(frame->step.base_depth_mm, -29.0) << "not 0 mm, where it never was";
  EXPECT_EQ(frame->step.force_axial_N, 0.5);
  EXPECT_EQ(frame->steps, 0u);
}

TEST(Replay, of_a_recording_with_rests_shows_every_moment_of_them) {
  RunRecording rested = recording();
  for (Step& step : rested.steps) {
    step.dt_s = 0.1;
    if (step.time_s > 0.35) step.time_s += 0.5;
  }
  rested.steps[3].rest_steps = 5;  // between 0.3 s and 0.9 s
  rested.frames.back().time_s = 1.5;
  Replay replay(rested, {{0}, {}});
  EXPECT_EQ(replay.duration_s(), 1.5);
  for (const auto& [time_s, steps, depth_mm] :
       {std::tuple{0.05, 0U, 1.0}, {0.31, 3U, 3.0}, {0.55, 5U, 3.0}, {0.85, 8U, 3.0}, {0.95, 9U, 4.0}}) {
    replay.seek(time_s);
    const auto frame = replay.picture(false);
    ASSERT_TRUE(frame) << time_s;
    EXPECT_EQ(frame->time_s, time_s);
    EXPECT_EQ(frame->steps, steps) << time_s;
    EXPECT_EQ(frame->step.base_depth_mm, depth_mm) << time_s;
  }
  const auto whole = replay.picture(true);
  ASSERT_EQ(whole->curve.size(), 11u) << "the last step of the rest as well";
  EXPECT_NEAR(whole->curve[3].time_s, 0.8, 1e-12);
  EXPECT_EQ(whole->curve[3].force_axial_N, 1.5);
}

TEST(Replay, warns_where_the_live_needle_did) {
  RunRecording flagged = recording();
  flagged.steps[3].flags = Step::no_contact_inside;
  flagged.steps[4].flags = Step::not_converged;
  Replay replay(flagged, {{0}, {}});
  for (const auto& [time_s, flags, trusted] : {std::tuple{0.35, 0U, true},
                                               {0.45, unsigned(Step::no_contact_inside), true},
                                               {0.55, unsigned(Step::not_converged), false},
                                               {0.65, 0U, true}}) {
    replay.seek(time_s);
    const auto frame = replay.picture(false);
    EXPECT_EQ(frame->step.flags, flags) << time_s;
    EXPECT_EQ((frame->bits & LiveFrame::trusted) != 0, trusted) << time_s;
  }
  const auto whole = replay.picture(true);
  EXPECT_EQ(whole->curve[3].flags, unsigned(Step::no_contact_inside));
  EXPECT_EQ(whole->curve[5].flags, 0U);
}

TEST(Replay, gives_the_whole_curve_when_asked) {
  Replay replay(recording(), {{0}, {}});
  const auto frame = replay.picture(true);
  ASSERT_EQ(frame->curve.size(), 10u);
  EXPECT_TRUE(frame->bits & LiveFrame::whole_curve);
  EXPECT_EQ(frame->curve[9].force_axial_N, 5.0);
}

TEST(Replay, shows_a_straight_needle_where_no_frame_was_recorded_yet) {
  RunRecording late = recording();
  late.frames.erase(late.frames.begin());  // the remaining frame is at 1 s
  for (Step& step : late.steps) {
    step.base.origin = {1, 2, step.base_depth_mm - 100.0};
    step.tip_mm = {1, 2, step.base_depth_mm};
  }
  for (const bool no_frames : {false, true}) {
    if (no_frames) late.frames.clear();
    Replay replay(late, {{3, 1}, {}});
    replay.seek(0.45);
    const auto frame = replay.picture(false);
    EXPECT_EQ(frame->centreline, (std::vector<float>{1, 2, -96, 1, 2, 4}));
    EXPECT_EQ(frame->step.tip_mm, Vec3(1, 2, 4));
    ASSERT_EQ(frame->displacement.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(moved(*frame, k), 0.0);
    EXPECT_EQ(frame->left_out_N, 2.0) << "the force whose displacement was not recorded";
  }
}

TEST(ReplayedSeeds, are_those_of_the_moment_and_move_as_the_nodes_around_them) {
  RunRecording run = recording();
  run.mesh.tets = {{0, 1, 2, 3}};
  run.mesh.tet_region = {0};
  run.mesh.regions = {"body"};
  run.frames[1].displacement = VecX::Zero(12);
  run.frames[1].displacement[2] = 2.0;  // the first node goes 2 mm to superior until 1 s
  SeedHistory first, second;
  first.rest_mm = Vec3(0.25, 0.25, 0.25);
  second.number = 1;
  second.rest_mm = Vec3(5, 5, 5);  // outside of the mesh
  RecordedImplant& implant = run.implant.emplace();
  implant.plan.needles.resize(1);
  implant.plan.seeds.resize(2);
  implant.plan.current = 0;
  implant.acts = {{SeedAct::Kind::earlier, 0.0, first},
                  {SeedAct::Kind::dropped, 0.4, second},
                  {SeedAct::Kind::taken_back, 0.8, second}};
  implant.doses = {{RecordedScore::kOfPlan, 2, 150.0, 103.0, 95.0}, {2, 2, 30.0, 20.0, 5.0}};
  Replay replay(std::move(run), {{3, 1}, {}});
  ReplayedSeeds seeds(replay);
  EXPECT_EQ(seeds.plan().plan.seeds.size(), 2u);
  auto now = seeds.news();
  ASSERT_TRUE(now);
  EXPECT_EQ(now->seeds.size(), 1u);
  EXPECT_EQ(now->planned_seeds, 2u);
  EXPECT_FALSE(now->now) << "its dose was not computed";
  EXPECT_EQ(now->planned->d90_Gy, 150.0);
  replay.seek(0.3);
  EXPECT_FALSE(seeds.news()) << "the same seeds";
  EXPECT_NEAR(seeds.places().now_mm[0].z(), 0.25 + 0.25 * 0.3 * 2.0, 1e-9);
  replay.seek(0.5);
  now = seeds.news();
  ASSERT_TRUE(now);
  EXPECT_EQ(now->seeds.size(), 2u);
  EXPECT_EQ(now->now->d90_percent, 20.0);
  ASSERT_EQ(seeds.places().now_mm.size(), 2u);
  EXPECT_EQ(seeds.places().now_mm[1], second.rest_mm) << "no tissue is known there";
  replay.seek(0.9);
  EXPECT_EQ(seeds.news()->seeds.size(), 1u);
  replay.seek(0.5);
  EXPECT_EQ(seeds.news()->seeds.size(), 2u) << "also backwards";
}

TEST(SeedJournal, tells_each_drop_and_each_seed_that_was_taken_back_once) {
  SeedJournal journal;
  LiveImplant implant;
  SeedHistory seed;
  seed.dropped_s = 3.0;
  implant.seeds = {seed};
  auto news = journal.news(implant, false, 0.0);
  ASSERT_EQ(news.acts.size(), 1u);
  EXPECT_EQ(news.acts[0].kind, SeedAct::Kind::earlier);
  EXPECT_EQ(news.acts[0].time_s, 0.0) << "not at the time of its own needle";
  seed.number = 1;
  seed.dropped_s = 1.5;
  implant.seeds.push_back(seed);
  news = journal.news(implant, false, 1.4);
  ASSERT_EQ(news.acts.size(), 1u);
  EXPECT_EQ(news.acts[0].kind, SeedAct::Kind::dropped);
  EXPECT_EQ(news.acts[0].time_s, 1.5);
  implant.now = ImplantScore{{.seeds = 2, .d90_Gy = 20.0}};
  EXPECT_TRUE(journal.news(implant, false, 1.6).doses.empty()) << "it may be of other seeds";
  news = journal.news(implant, true, 1.6);
  EXPECT_TRUE(news.acts.empty());
  ASSERT_EQ(news.doses.size(), 1u);
  EXPECT_EQ(news.doses[0].acts, 2);
  // Taken back and dropped again at another place between two calls.
  implant.seeds.back().dropped_s = 2.5;
  news = journal.news(implant, false, 2.6);
  ASSERT_EQ(news.acts.size(), 2u);
  EXPECT_EQ(news.acts[0].kind, SeedAct::Kind::taken_back);
  EXPECT_EQ(news.acts[1].kind, SeedAct::Kind::dropped);
  implant.seeds.clear();
  EXPECT_EQ(journal.news(implant, false, 3.0).acts.size(), 2u);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_patient.hpp"
#include "support/count_allocations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace stylet;
using namespace stylet::test;

namespace {

/// The run that most tests use, computed once.
const Finished& standard() {
  static const Finished run(compiled(box_scenario()));
  return run;
}

std::string what_happened(const Summary& summary) {
  std::string all;
  for (const Event& e : summary.events) {
    if (!all.empty()) all += ", ";
    all += to_string(e.kind);
    if (!e.region.empty()) all += " " + e.region;
  }
  return all;
}

void expect_same_bits(const Step& a, const Step& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.base_depth_mm, b.base_depth_mm);
  EXPECT_EQ(a.force_axial_N, b.force_axial_N);
  EXPECT_EQ(a.force_sagittal_N, b.force_sagittal_N);
  EXPECT_EQ(a.force_lateral_N, b.force_lateral_N);
  EXPECT_EQ(a.torque_Nmm, b.torque_Nmm);
  EXPECT_EQ(a.tip_mm, b.tip_mm);
  EXPECT_EQ(a.tip_state, b.tip_state);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.sticking, b.sticking);
  EXPECT_EQ(a.iterations, b.iterations);
}

/// A needle whose base the test moves itself.
class ByHand {
 public:
  explicit ByHand(const Scenario& scenario = box_scenario())
      : model_(compiled(scenario)), simulation(model_), insertion(model_->insertions()[0]) {
    simulation.place(pose(), insertion.entry, insertion.direction);
  }
  const Step& go(double depth_mm, const Vec3& aside = Vec3::Zero(), double dt = 4e-3) {
    const double from = depth;
    const Vec3 aside_from = sideways;
    const int steps =
        std::max(1, static_cast<int>(std::ceil((std::abs(depth_mm - from) + (aside - aside_from).norm()) / 0.2)));
    for (int k = 1; k <= steps; ++k) {
      const double f = static_cast<double>(k) / steps;
      depth = from + f * (depth_mm - from);
      sideways = aside_from + f * (aside - aside_from);
      simulation.prepare();
      simulation.step(pose(), dt);
      for (const Event& e : simulation.new_events()) events.push_back(e);
    }
    return simulation.last_step();
  }
  [[nodiscard]] Pose pose() const {
    return pose_along(
        insertion.entry + sideways + (depth - simulation.insertion().needle().length()) * insertion.direction,
        insertion.direction);
  }

 private:
  std::shared_ptr<const Model> model_;

 public:
  Simulation simulation;
  PlannedInsertion insertion;
  double depth = -2.0;
  Vec3 sideways = Vec3::Zero();
  std::vector<Event> events;
};

}  // namespace

TEST(Run, events_come_in_the_order_of_an_insertion_and_withdrawal) {
  EXPECT_EQ(what_happened(standard().summary),
            "skin_contact body, puncture body, region_entered body, puncture prostate, region_entered prostate, "
            "retraction_start, slip_start, withdrawn");
  const auto& events = standard().summary.events;
  for (std::size_t k = 1; k < events.size(); ++k) EXPECT_LE(events[k - 1].time_s, events[k].time_s);
}

TEST(Run, events_say_where_and_at_what_force) {
  const Finished& r = standard();
  EXPECT_NEAR(r.event(EventKind::skin_contact)->depth_mm, 0.0, 0.2);
  // The membrane breaks between two recorded steps, so its force is known only within the rise of one step.
  double rise = 0.0;
  for (std::size_t k = 1; k < r.kept.steps.size(); ++k)
    rise = std::max(rise, r.kept.steps[k].force_axial_N - r.kept.steps[k - 1].force_axial_N);
  EXPECT_LE(r.event(EventKind::puncture, "body")->force_N, default_tissue("body").puncture_N + 1e-5);
  EXPECT_GE(r.event(EventKind::puncture, "body")->force_N, default_tissue("body").puncture_N - rise);
  // At the capsule the friction on the shaft adds to the force of the membrane.
  EXPECT_GT(r.event(EventKind::puncture, "prostate")->force_N, default_tissue("prostate").puncture_N);
  EXPECT_LT(r.event(EventKind::puncture, "prostate")->force_N, default_tissue("prostate").puncture_N + 0.030 * 30.0);
  EXPECT_NEAR(r.event(EventKind::retraction_start)->depth_mm, r.model->insertions()[0].depth_mm, 1e-9);
  EXPECT_GT(r.event(EventKind::retraction_start)->force_N, 0.0) << "still pushing when it turns round";
  EXPECT_LT(r.event(EventKind::slip_start)->force_N, 0.0) << "the tissue is dragged out";
  EXPECT_LT(r.event(EventKind::withdrawn)->depth_mm, 0.5);
}

TEST(Run, retraction_starts_when_the_pause_ends) {
  const Finished& r = standard();
  const auto& samples = r.model->insertions()[0].motion.samples();
  ASSERT_EQ(samples.size(), 5u) << "the last one is a rest, in which the tissue goes back";
  EXPECT_NEAR(r.event(EventKind::retraction_start)->time_s, samples[2].time_s, 0.0041);
}

TEST(Run, two_runs_give_the_same_bits) {
  const Finished& a = standard();
  const Finished b(compiled(box_scenario()));
  ASSERT_EQ(a.kept.steps.size(), b.kept.steps.size());
  for (std::size_t k = 0; k < a.kept.steps.size(); ++k) {
    expect_same_bits(a.kept.steps[k], b.kept.steps[k]);
    if (HasFailure()) FAIL() << "step " << k;
  }
  ASSERT_EQ(a.kept.frames.size(), b.kept.frames.size());
  for (std::size_t f = 0; f < a.kept.frames.size(); ++f)
    EXPECT_EQ(a.kept.frames[f].displacement, b.kept.frames[f].displacement);
  EXPECT_EQ(what_happened(a.summary), what_happened(b.summary));
}

TEST(Run, times_are_exact_multiples_of_the_step) {
  for (std::size_t k = 0; k < standard().kept.steps.size(); ++k)
    EXPECT_EQ(standard().kept.steps[k].time_s, static_cast<double>(4 * (k + 1)) / 1000.0);
}

TEST(Run, frames_are_labelled_by_what_they_show) {
  const Finished& r = standard();
  std::vector<std::string> labels;
  for (const Frame& f : r.kept.frames) {
    if (!f.label.empty()) labels.push_back(f.label);
  }
  EXPECT_EQ(labels, (std::vector<std::string>{"before", "skin_contact", "puncture", "puncture", "deepest", "slip_start",
                                              "after"}));
  EXPECT_GT(r.kept.frames.size(), labels.size()) << "the regular series";
  const Frame& before = *r.frame("before");
  EXPECT_EQ(before.displacement.norm(), 0.0);
  EXPECT_TRUE(before.contacts.empty());
  EXPECT_NEAR(before.base_depth_mm, -3.0, 1e-9);
  EXPECT_EQ(before.time_s, 0.0);
  const Frame& deepest = *r.frame("deepest");
  EXPECT_NEAR(deepest.base_depth_mm, r.model->insertions()[0].depth_mm, 1e-9);
  EXPECT_EQ(deepest.time_s, r.event(EventKind::retraction_start)->time_s);
  EXPECT_GT(deepest.contacts.size(), 5u);
  EXPECT_GE(deepest.needle.size(), 2u);
  EXPECT_NEAR((deepest.needle.front() - Vec3(4, 7, deepest.base_depth_mm - 120.0)).norm(), 0.0, 1e-9);
  const Frame& after = *r.frame("after");
  EXPECT_LT(after.displacement.norm(), 0.05 * deepest.displacement.norm()) << "what crept is nearly back";
  EXPECT_TRUE(after.contacts.empty());
}

TEST(Run, the_regular_series_has_the_asked_rate_and_at_most_the_asked_number) {
  const auto unlabelled = [](double per_second, int most) {
    Scenario s = box_scenario();
    s.output.frames_per_s = per_second;
    s.output.max_frames = most;
    const Finished r(compiled(s));
    return std::count_if(r.kept.frames.begin(), r.kept.frames.end(), [](const Frame& f) { return f.label.empty(); });
  };
  EXPECT_EQ(unlabelled(0.0, 80), 0) << "events only";
  EXPECT_LE(unlabelled(1000.0, 20), 20);
  EXPECT_GE(unlabelled(1000.0, 20), 14);
  const double seconds = standard().kept.steps.back().time_s;
  EXPECT_NEAR(static_cast<double>(unlabelled(5.0, 500)), 5.0 * seconds, 3.0);
}

TEST(Run, the_summary_is_that_of_the_records) {
  const Finished& r = standard();
  const Summary& s = r.summary;
  double axial = 0, sagittal = 0, lateral = 0, off = 0;
  int contacts = 0;
  std::vector<double> us;
  for (const Step& step : r.kept.steps) {
    axial = std::max(axial, std::abs(step.force_axial_N));
    sagittal = std::max(sagittal, std::abs(step.force_sagittal_N));
    lateral = std::max(lateral, std::abs(step.force_lateral_N));
    contacts = std::max(contacts, step.contacts);
    off = std::max(off, std::hypot(step.tip_mm.x() - 4.0, step.tip_mm.y() - 7.0));
    us.push_back(step.step_us);
  }
  EXPECT_EQ(s.peak_axial_N, axial);
  EXPECT_EQ(s.peak_sagittal_N, sagittal);
  EXPECT_EQ(s.peak_lateral_N, lateral);
  EXPECT_EQ(s.contacts_max, contacts);
  EXPECT_EQ(s.steps, static_cast<Index>(r.kept.steps.size()));
  EXPECT_NEAR(s.tip_deflection_mm, off, 1e-9);
  EXPECT_EQ(s.step_us_max, *std::max_element(us.begin(), us.end()));
  EXPECT_LE(s.step_us_p50, s.step_us_p99);
  EXPECT_LE(s.step_us_p99, s.step_us_p999);
  EXPECT_LE(s.step_us_p999, s.step_us_max);
  EXPECT_GT(s.step_us_p50, 0.0);
  EXPECT_EQ(s.nodes, 343);
  EXPECT_EQ(s.tets, 6 * 216);
  EXPECT_EQ(s.scenario, "box");
  EXPECT_TRUE(s.warnings.empty()) << s.warnings.front();
}

TEST(Run, the_gland_is_pushed_along_the_needle) {
  const Summary& s = standard().summary;
  const Vec3& shift = s.target_shift_centroid_mm;
  EXPECT_GT(shift.z(), 0.02);
  EXPECT_GT(shift.z(), 0.9 * shift.norm());
  EXPECT_GE(s.target_shift_max_mm, shift.norm());
  EXPECT_LT(s.target_shift_max_mm, 20.0);
}

TEST(Run, needle_tissue_and_supports_balance) {
  EXPECT_LE(standard().summary.residual_force_balance, 1e-9);
  EXPECT_LE(standard().summary.residual_torque_balance, 1e-9);
  for (const char* rule : {"paper", "embedded"}) {
    Scenario s = box_scenario();
    if (rule == std::string("paper")) {
      s.coupling.rule = choice<CouplingSettings::Rule>(rule).value();
    } else {
      s.coupling.method = choice<CouplingSettings::Method>(rule).value();
    }
    const Finished r(compiled(s));
    EXPECT_LE(r.summary.residual_force_balance, 1e-9) << rule;
    EXPECT_LE(r.summary.residual_torque_balance, 1e-9) << rule;
    EXPECT_NE(r.event(EventKind::puncture, "prostate"), nullptr) << rule;
    EXPECT_NE(r.event(EventKind::withdrawn), nullptr) << rule;
  }
}

TEST(Run, a_second_needle_finds_the_tissue_unloaded) {
  Scenario first = box_scenario();
  first.fixed.outer = OuterSupport::none;  // "sides" would hold other nodes for other entries
  first.fixed.box_mm = {-31, -31, 45, 31, 31, 61};
  Scenario alone = first;
  alone.insertions[0].entry_mm = {-8.0, 2.0, -20.0};
  Scenario both = first;
  both.insertions.push_back(alone.insertions[0]);
  const Finished one(compiled(first));
  const Finished second(compiled(alone));
  const Finished two(compiled(both));
  const std::size_t first_steps = one.kept.steps.size();
  ASSERT_EQ(two.kept.steps.size(), first_steps + second.kept.steps.size());
  const double started = two.kept.steps[first_steps - 1].time_s;
  for (std::size_t k = 0; k < second.kept.steps.size(); ++k) {
    const Step& a = second.kept.steps[k];
    const Step& b = two.kept.steps[first_steps + k];
    ASSERT_NEAR(a.force_axial_N, b.force_axial_N, 1e-9) << k;
    ASSERT_NEAR(a.force_lateral_N, b.force_lateral_N, 1e-9) << k;
    ASSERT_NEAR(a.base_depth_mm, b.base_depth_mm, 1e-9) << k;
    ASSERT_NEAR(a.time_s + started, b.time_s, 1e-9) << k;
  }
  int befores = 0;
  for (const Frame& f : two.kept.frames) {
    if (f.label != "before") continue;
    ++befores;
    EXPECT_EQ(f.displacement.norm(), 0.0);
    EXPECT_NEAR(f.base_depth_mm, -3.0, 1e-9);
  }
  EXPECT_EQ(befores, 2);
  EXPECT_EQ(what_happened(two.summary), what_happened(one.summary) + ", " + what_happened(second.summary));
}

TEST(Run, stops_where_a_recorded_motion_leaves_the_needle_in_before_the_next) {
  Scenario s = box_scenario();
  const auto whole = compiled(s)->insertions()[0].motion.samples();
  s.insertions.insert(s.insertions.begin(), InsertionPlan{});
  s.insertions[0].motion = "motion.csv";
  const auto model = compiled(s, box_patient(), {{whole[0], whole[1]}, {}});
  Kept kept;
  const auto result = run(model, kept);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  EXPECT_SAYS(result.error().message(), "insertion[0]: the needle is still in the tissue");
}

TEST(Run, a_recorded_motion_equal_to_the_plan_gives_the_same_forces) {
  Scenario s = box_scenario();
  s.insertions[0] = {};
  s.insertions[0].motion = "motion.csv";
  const Finished r(compiled(s, box_patient(), {standard().model->insertions()[0].motion.samples()}));
  EXPECT_NEAR((r.model->insertions()[0].entry - Vec3(4, 7, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(r.model->insertions()[0].depth_mm, standard().model->insertions()[0].depth_mm, 1e-9);
  ASSERT_EQ(r.kept.steps.size(), standard().kept.steps.size());
  for (std::size_t k = 0; k < r.kept.steps.size(); ++k)
    ASSERT_NEAR(r.kept.steps[k].force_axial_N, standard().kept.steps[k].force_axial_N, 1e-7) << k;
  EXPECT_EQ(what_happened(r.summary), what_happened(standard().summary));
}

TEST(Run, a_trembling_hand_does_not_start_retractions) {
  Scenario s = box_scenario();
  auto samples = standard().model->insertions()[0].motion.samples();
  const BaseMotion plan(samples);
  std::vector<MotionSample> trembling;
  for (int k = 0; k <= static_cast<int>(plan.duration_s() / 4e-3); ++k) {
    MotionSample sample{4e-3 * k, plan.at(4e-3 * k)};
    sample.base.origin.z() += k % 2 == 0 ? 0.01 : -0.01;
    trembling.push_back(sample);
  }
  s.insertions[0] = {};
  s.insertions[0].motion = "motion.csv";
  const Finished r(compiled(s, box_patient(), {trembling}));
  const auto& events = r.summary.events;
  EXPECT_EQ(
      std::count_if(events.begin(), events.end(), [](const Event& e) { return e.kind == EventKind::retraction_start; }),
      1);
}

TEST(Run, deepest_is_the_deepest_point_also_where_the_needle_goes_in_twice) {
  Scenario s = box_scenario();
  const auto pose = [&](double depth) { return pose_along({4, 7, depth - 120.0}, Vec3::UnitZ()); };
  s.insertions[0] = {};
  s.insertions[0].motion = "motion.csv";
  const Finished r(compiled(s, box_patient(),
                            {{{0.0, pose(-3)},
                              {0.6, pose(20)},
                              {0.8, pose(15)},
                              {1.4, pose(38)},
                              {2.0, pose(20)},
                              {2.4, pose(30)},
                              {3.2, pose(-3)}}}));
  ASSERT_NE(r.frame("deepest"), nullptr);
  EXPECT_NEAR(r.frame("deepest")->base_depth_mm, 38.0, 1e-6);
  const auto& events = r.summary.events;
  EXPECT_EQ(
      std::count_if(events.begin(), events.end(), [](const Event& e) { return e.kind == EventKind::retraction_start; }),
      3);
}

TEST(Run, an_observer_can_stop_it) {
  struct Stops final : RunObserver {
    int steps = 0;
    Result<> on_step(const Step&) override {
      if (++steps == 5) return failure("disk", "is full", "Make room");
      return Ok{};
    }
    Result<> on_frame(const Frame&) override { return Ok{}; }
  } observer;
  const auto result = run(standard().model, observer);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().what, "is full");
  EXPECT_EQ(observer.steps, 5);
}

// Forces of the hand.

TEST(HandForce, is_positive_pushing_and_negative_pulling) {
  ByHand hand;
  EXPECT_GT(hand.go(30).force_axial_N, 0.3);
  EXPECT_LT(hand.go(25).force_axial_N, -0.1);
}

TEST(HandForce, is_lateral_to_the_patients_left_and_sagittal_to_posterior) {
  ByHand left;
  left.go(30);
  Step before = left.simulation.last_step();
  const Step to_left = left.go(30, {3, 0, 0});
  EXPECT_GT(to_left.force_lateral_N - before.force_lateral_N, 0.05);
  EXPECT_LT(std::abs(to_left.force_sagittal_N - before.force_sagittal_N), 0.3 * to_left.force_lateral_N);
  // The tissue lies in front (+z) of the base, so the torque is r × F = z × x = +y.
  EXPECT_GT(to_left.torque_Nmm.y() - before.torque_Nmm.y(), 5.0);

  ByHand back;
  back.go(30);
  before = back.simulation.last_step();
  const Step to_posterior = back.go(30, {0, 3, 0});
  EXPECT_GT(to_posterior.force_sagittal_N - before.force_sagittal_N, 0.05);
  EXPECT_LT(to_posterior.torque_Nmm.x() - before.torque_Nmm.x(), -5.0);  // z × y = −x
}

TEST(Run, slip_starts_when_the_shaft_slides_out_and_the_hand_pulls) {
  for (const double out_mm : {0.05, 0.19}) {  // per step: 12 and 47 mm/s, without a pause at the turn
    SCOPED_TRACE(testing::Message() << out_mm << " mm a step");
    ByHand hand;
    hand.go(35.0);
    ASSERT_GT(hand.simulation.last_step().force_axial_N, 0.0);
    double most_sticking = 0.0;  // largest share of contacts that stick, before slip starts
    const Event* slip = nullptr;
    while (slip == nullptr && hand.depth > 20.0) {
      const std::size_t before = hand.events.size();
      const Step& record = hand.go(hand.depth - out_mm);
      most_sticking = std::max(most_sticking, static_cast<double>(record.sticking) / record.contacts);
      for (std::size_t k = before; k < hand.events.size(); ++k)
        if (hand.events[k].kind == EventKind::slip_start) slip = &hand.events[k];
    }
    ASSERT_NE(slip, nullptr);
    EXPECT_LT(slip->force_N, 0.0) << "a pull";
    EXPECT_GT(most_sticking, 0.6) << "the tissue stuck to the needle first";
    EXPECT_GT(hand.simulation.last_step().sliding_out_share, 0.5);
    EXPECT_LT(slip->depth_mm, 35.0 - 0.3);
    EXPECT_NEAR(slip->depth_mm, hand.depth, 1e-9);
  }
}

TEST(HandForce, of_elastic_tissue_relaxes_in_a_pause_by_the_viscous_parts_only) {
  Scenario elastic = box_scenario();
  elastic.tissue_model.creep = 1.0;
  ByHand hand(elastic);
  const double depth = 35.0;
  const double moving = hand.go(depth).force_axial_N;
  double force = moving;
  for (int k = 0; k < 50; ++k) {
    const double now = hand.go(depth).force_axial_N;
    EXPECT_LE(now, force + 1e-9) << "it only falls";
    force = now;
  }
  // Viscous friction b v ℓ plus the tip's viscosity times v, with v = 0.2 mm per 4 ms.
  const double v = 0.2 / 4e-3;
  const double viscous = 250e-6 * v * depth + 2e-3 * v;
  EXPECT_LT(moving - force, viscous);
  const TissueParameters gland = default_tissue("prostate");
  EXPECT_GT(force, gland.cutting_N + 0.5 * 1e-3 * gland.friction_coulomb_N_per_m * depth)
      << "cutting and Coulomb friction stay";
  const double settled = force;
  for (int k = 0; k < 50; ++k) force = hand.go(depth).force_axial_N;
  EXPECT_NEAR(force, settled, 2e-3 * moving);
}

TEST(Simulation, a_step_does_not_allocate) {
  if (!AllocationCount::available())
    GTEST_SKIP() << "under a sanitizer the memory functions cannot be replaced by counting ones";
  ByHand hand;
  hand.go(-1.0);
  long allocations = 0;
  int most_contacts = 0;
  for (double depth = -1.0; depth < 40.0; depth += 0.2) {
    hand.depth = depth;
    hand.simulation.prepare();
    const Pose base = hand.pose();
    const AllocationCount count;
    hand.simulation.step(base, 4e-3);
    allocations += count.count();
    most_contacts = std::max(most_contacts, hand.simulation.last_step().contacts);
  }
  for (double depth = 40.0; depth > -3.0; depth -= 0.2) {
    hand.depth = depth;
    hand.simulation.prepare();
    const Pose base = hand.pose();
    const AllocationCount count;
    hand.simulation.step(base, 4e-3);
    allocations += count.count();
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(most_contacts, 5);
  EXPECT_EQ(hand.simulation.last_step().tip_state, TipState::air);
}

TEST(Simulation, a_step_to_nowhere_or_in_no_time_is_not_taken) {
  const auto model = compiled(box_scenario());
  const PlannedInsertion& plan = model->insertions()[0];
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Simulation disturbed(model), plain(model);
  for (Simulation* s : {&disturbed, &plain}) s->place(plan.motion.at(0.0), plan.entry, plan.direction);
  for (int k = 1; k <= 150; ++k) {
    const Pose base = plan.motion.at(4e-3 * k);
    Pose nowhere = base;
    nowhere.origin[k % 3] = nan;
    const Step before = disturbed.last_step();
    for (const Step& record : {disturbed.step(nowhere, 4e-3), disturbed.step(base, nan), disturbed.step(base, 0.0)})
      expect_same_bits(record, before);
    EXPECT_EQ(disturbed.last_step().flags, unsigned(Step::invalid_input));
    EXPECT_TRUE(disturbed.new_events().empty());
    expect_same_bits(disturbed.step(base, 4e-3), plain.step(base, 4e-3));
    ASSERT_EQ(disturbed.new_events().size(), plain.new_events().size());
  }
  EXPECT_GT(plain.last_step().force_axial_N, 0.3);
}

TEST(Simulation, reports_the_bone_it_hits) {
  Scenario s = box_scenario();
  s.insertions[0].entry_mm = {0.0, -25.0, -20.0};
  s.insertions[0].depth_mm = 19.0;
  ByHand hand(s);
  hand.go(24.0);
  ASSERT_FALSE(hand.events.empty());
  EXPECT_EQ(hand.events.back().kind, EventKind::bone_contact);
  EXPECT_EQ(hand.events.back().region, "pubic_arch");
  EXPECT_EQ(hand.simulation.last_step().tip_state, TipState::bone);
}

// Motion of the base.

TEST(BaseMotion, straight_goes_in_waits_and_comes_back) {
  const Vec3 along = Vec3(1, 2, 2) / 3.0;
  const BaseMotion m = BaseMotion::straight({1, 2, 3}, along, 100.0, 5.0, 20.0, 10.0, 0.5, true, 50.0);
  const auto depth = [&](double t) {
    const Pose p = m.at(t);
    EXPECT_NEAR((p.rotation * Vec3::UnitZ() - along).norm(), 0.0, 1e-12);
    const Vec3 tip = p.origin + 100.0 * along - Vec3(1, 2, 3);
    EXPECT_NEAR(tip.cross(along).norm(), 0.0, 1e-9);
    return tip.dot(along);
  };
  EXPECT_NEAR(depth(0.0), -5.0, 1e-9);
  EXPECT_NEAR(depth(0.5), 0.0, 1e-9);
  EXPECT_NEAR(depth(2.5), 20.0, 1e-9);
  EXPECT_NEAR(depth(2.9), 20.0, 1e-9);
  EXPECT_NEAR(depth(3.2), 10.0, 1e-9);
  EXPECT_NEAR(m.duration_s(), 3.5, 1e-12);
  EXPECT_NEAR(depth(9.0), -5.0, 1e-9) << "at rest after the end";
  EXPECT_NEAR(depth(-1.0), -5.0, 1e-9) << "and before the start";
}

TEST(BaseMotion, straight_without_pause_and_retraction_ends_in_depth) {
  const BaseMotion m = BaseMotion::straight(Vec3::Zero(), Vec3::UnitZ(), 100.0, 5.0, 20.0, 10.0, 0.0, false, 50.0);
  EXPECT_EQ(m.samples().size(), 2u);
  EXPECT_NEAR(m.at(m.duration_s()).origin.z(), -80.0, 1e-9);
}

TEST(BaseMotion, turns_by_the_shorter_way_at_constant_speed) {
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(1.2, Vec3(1, 1, 0).normalized()));
  const Eigen::Quaterniond same_turn(-quarter.w(), -quarter.x(), -quarter.y(), -quarter.z());
  const BaseMotion m({{1.0, {Vec3::Zero(), Eigen::Quaterniond::Identity()}}, {3.0, {Vec3(0, 0, 8), same_turn}}});
  for (const double f : {0.0, 0.25, 0.5, 1.0}) {
    const Pose p = m.at(1.0 + 2.0 * f);
    EXPECT_NEAR(p.rotation.angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(1.2 * f, Vec3(1, 1, 0).normalized()))),
                0.0, 1e-7);
    EXPECT_NEAR(p.origin.z(), 8.0 * f, 1e-12);
  }
}

TEST(BaseMotion, a_pose_along_a_direction_keeps_x_near_the_patients_left) {
  for (const Vec3& d :
       {Vec3(0, 0, 1), Vec3(0.2, -0.3, 1), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, -2)}) {
    const Pose p = pose_along({1, 2, 3}, d);
    EXPECT_NEAR((p.rotation * Vec3::UnitZ() - d.normalized()).norm(), 0.0, 1e-12) << d.transpose();
    EXPECT_GE((p.rotation * Vec3::UnitX()).x(), -1e-12) << d.transpose();
    EXPECT_NEAR((p.rotation * Vec3::UnitY()).x(), 0.0, 1e-12) << d.transpose();
  }
}

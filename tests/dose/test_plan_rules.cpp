// SPDX-License-Identifier: GPL-3.0-or-later
// The rules for plans, the decay while a temporary implant lies, and plans with several kinds of source.
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/plan_rules.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace stylet {
namespace {

DosePlan seeds_of(const std::string& isotope, double strength_U) {
  DosePlan plan;
  plan.file = "plan";
  plan.isotope = isotope;
  for (int k = 0; k < 8; ++k) {
    PlannedSource seed;
    seed.at_mm = Vec3(10.0 * (k % 2), 10.0 * (k / 2 % 2), 10.0 * (k / 4));
    seed.has_axis = true;
    seed.strength_U = strength_U;
    plan.sources.push_back(seed);
  }
  return plan;
}

Result<std::vector<std::string>> judged(const DosePlan& plan, const std::string& model) {
  const std::vector<SourceModel> models{find_source(model).value()};
  return judge_plan(plan, models, {}, {});
}

bool says(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

TEST(PlanRules, have_names_of_their_own_and_all_columns) {
  std::set<std::string> names;
  for (const PlanRule& rule : plan_rules()) {
    EXPECT_TRUE(names.insert(rule.name).second) << rule.name;
    EXPECT_FALSE(rule.bound.empty() || rule.verdict.empty() || rule.reason.empty()) << rule.name;
  }
  EXPECT_GE(names.size(), 30U);
}

TEST(PlanRules, find_nothing_in_usual_plans_of_each_isotope) {
  EXPECT_TRUE(judged(seeds_of("I-125", 0.5), "i125_6711").value().empty());
  EXPECT_TRUE(judged(seeds_of("103Pd", 2.0), "pd103_theraseed200").value().empty());
  EXPECT_TRUE(judged(seeds_of("Cs131", 2.5), "cs131_cs1rev2").value().empty());
  DosePlan hdr = seeds_of("Ir-192", 40000.0);
  hdr.implant = Implant::temporary;
  for (PlannedSource& s : hdr.sources) s.dwell_s = 10.0;
  EXPECT_TRUE(judged(hdr, "ir192_flexisource").value().empty());
  DosePlan plaque = seeds_of("Cs-131", 2.5);
  plaque.implant = Implant::temporary;
  for (PlannedSource& s : plaque.sources) s.dwell_s = 7.0 * 86400.0;
  EXPECT_TRUE(judged(plaque, "cs131_cs1rev2").value().empty());
}

TEST(PlanRules, refuse_or_tell_strengths_in_other_units) {
  for (const double refused : {0.0185, 5e-7, 18500.0, 1.85e7})
    EXPECT_FALSE(judged(seeds_of("I-125", refused), "i125_6711").ok()) << refused;
  EXPECT_TRUE(says(judged(seeds_of("I-125", 18.5), "i125_6711").value(), "seed strength")) << "MBq";
}

TEST(PlanRules, refuse_a_channel_with_weights_and_without_its_time_by_its_name) {
  DosePlan plan = seeds_of("Ir-192", 40000.0);
  plan.implant = Implant::temporary;
  for (PlannedSource& s : plan.sources) s.dwell_s = 10.0;
  ChannelSays channel;
  channel.where = "plan, application setup 1, channel 4";
  channel.weights = 30.0;
  plan.says.channels.push_back(channel);
  const auto refused = judged(plan, "ir192_flexisource");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message().find("channel 4"), std::string::npos);
  plan.says.channels[0].total_s = 30.0;
  plan.says.channels[0].final_weight = 20.0;
  EXPECT_TRUE(says(judged(plan, "ir192_flexisource").value(), "channel weights"));
}

// The dose rate falls while the sources lie: the dose is that until they have decayed, less that of what is left.
TEST(TemporaryImplant, decays_while_it_lies) {
  const SourceModel source = find_source("cs131_cs1rev2").value();
  DosePlan plan = seeds_of("Cs-131", 2.5);
  DoseOptions options;
  options.grid_step_mm = 5.0;
  options.points = {Vec3(5, 5, 20), Vec3(-8, 3, 4)};
  for (const double days : {0.01, 1.0, 7.0, 30.0}) {
    options.quantity = DoseQuantity::until;
    options.days = days;
    plan.implant = Implant::permanent;
    for (PlannedSource& s : plan.sources) s.dwell_s = 0.0;
    const std::vector<double> until = evaluate_dose(plan, source, {}, options).value().point_Gy;
    plan.implant = Implant::temporary;
    for (PlannedSource& s : plan.sources) s.dwell_s = days * 86400.0;
    const std::vector<double> lying = evaluate_dose(plan, source, {}, options).value().point_Gy;
    for (std::size_t p = 0; p < until.size(); ++p) EXPECT_NEAR(lying[p] / until[p], 1.0, 1e-9) << days;
  }
  const double x = std::numbers::ln2 * 7.0 / 9.689;
  EXPECT_NEAR(mean_strength_while_decaying(168.0, 9.689), (1.0 - std::exp(-x)) / x, 1e-12);
}

TEST(SeveralSources, add_up_with_a_model_and_a_half_life_each) {
  DosePlan iodine = seeds_of("I-125", 0.5), palladium = seeds_of("Pd-103", 2.0), both = iodine;
  SourceKind kind;
  kind.id = "2";
  kind.isotope = "Pd-103";
  both.more_kinds.push_back(kind);
  for (PlannedSource s : palladium.sources) {
    s.at_mm.x() += 5.0;
    s.kind = 1;
    both.sources.push_back(s);
    s.kind = 0;
    palladium.sources[both.sources.size() - 9] = s;
  }
  const SourceModel first = find_source("i125_6711").value(), second = find_source("pd103_theraseed200").value();
  DoseOptions options;
  options.grid_step_mm = 5.0;
  options.points = {Vec3(5, 5, 20), Vec3(-8, 3, 4)};
  const auto a = evaluate_dose(iodine, first, {}, options).value();
  const auto b = evaluate_dose(palladium, second, {}, options).value();
  EXPECT_FALSE(evaluate_dose(both, first, {}, options).ok()) << "one model for two kinds";
  options.more_sources = {second};
  const auto sum = evaluate_dose(both, first, {}, options).value();
  for (std::size_t p = 0; p < options.points.size(); ++p)
    EXPECT_NEAR(sum.point_Gy[p] / (a.point_Gy[p] + b.point_Gy[p]), 1.0, 1e-12);
}

// No place within a capsule has more dose than the hottest place of its surface, in the centre or on the axis either.
TEST(Capsule, holds_no_dose_above_that_of_its_surface) {
  for (const SourceModel& source : known_sources()) {
    const Tg43 tg43 = Tg43::create(source, DoseFormalism::line2d).value();
    const double half = 0.5 * source.outer_length_mm, radius = 0.5 * source.outer_diameter_mm;
    const auto rate = [&](double along, double across) {
      const double r = std::hypot(along, across);
      return tg43.rate(r, r > 0.0 ? along / r : 0.0);
    };
    double surface = 0.0, within = 0.0;
    for (int k = -20000; k <= 20000; ++k) {
      surface = std::max(surface, rate(half * k / 20000.0, radius));
      surface = std::max(surface, rate(std::copysign(half, k), radius * std::abs(k) / 20000.0));
    }
    for (int k = -100; k <= 100; ++k) {
      for (int i = 0; i <= 50; ++i)
        within = std::max(within, rate(0.999 * half * k / 100.0, 0.999 * radius * i / 50.0));
    }
    EXPECT_LE(within, surface * (1.0 + 1e-4)) << source.name;
    EXPECT_NEAR(rate(half, 0.3 * radius) / rate(0.5 * half, 0.15 * radius), 1.0, 1e-9) << "in one direction";
  }
}

TEST(DoseRates, are_not_judged_by_goals) {
  DoseOptions options;
  options.grid_step_mm = 5.0;
  options.prescription_Gy = 145.0;
  options.goals = {{"prostate", "D90_percent", true, 100.0, "here"}, {"prostate", "D90_Gy", true, 0.001, "here"}};
  DoseStructure target{"Prostate", "prostate", "", {{Vec3(5, 5, 5), Vec3(6, 5, 5)}, {4000.0, 4000.0}}, {}, {}};
  options.quantity = DoseQuantity::initial_rate;
  const auto e = evaluate_dose(seeds_of("I-125", 0.5), find_source("i125_6711").value(), {&target, 1}, options).value();
  EXPECT_EQ(e.prescription_Gy, 0.0);
  for (const JudgedGoal& goal : e.goals) EXPECT_FALSE(goal.value.has_value() || goal.met);
}

}  // namespace
}  // namespace stylet

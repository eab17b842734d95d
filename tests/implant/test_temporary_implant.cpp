// SPDX-License-Identifier: GPL-3.0-or-later
// Implants with catheters that stay, in a cubic patient: where the dwell positions are at planning and at delivery.
#include "implant/dwell_positions.hpp"
#include "sim/box_patient.hpp"
#include "stylet/implant/implant.hpp"
#include "stylet/implant/seed_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace stylet {
namespace {

constexpr double kSource_mm = 4.5;
constexpr double kTip_mm = 6.0;

/// Two catheters with three dwell positions each; the last one of each has no time.
DosePlan two_catheters() {
  DosePlan plan;
  plan.file = "plan.csv";
  plan.implant = Implant::temporary;
  for (const auto& [name, x, y] : {std::tuple{"1", 6.0, 4.0}, std::tuple{"2", -4.0, 9.0}}) {
    for (const double z : {38.0, 33.0, 28.0}) {
      plan.sources.push_back({.at_mm = Vec3(x, y, z),
                              .axis = Vec3::UnitZ(),
                              .has_axis = true,
                              .strength_U = 40000.0,
                              .dwell_s = z > 30.0 ? 5.0 : 0.0,
                              .needle = name});
    }
  }
  return plan;
}

Scenario catheter_scenario() {
  Scenario s = test::box_scenario();
  s.insertions.clear();
  s.procedure.speed_mm_per_s = 40.0;
  s.procedure.pause_s = 0.5;
  s.procedure.planning_to_delivery_s = 600.0;
  return s;
}

ImplantHistory simulated_catheters(const Scenario& s, const TetMesh& mesh, const DosePlan& plan) {
  auto history = simulate_implant(s, mesh, load_catheters(plan, kTip_mm).value(), kSource_mm, "case.toml");
  if (!history) throw std::runtime_error(history.error().message());
  return *history;
}

double largest_wait(const ImplantHistory& history) {
  double largest = 0.0;
  for (const SeedHistory& dwell : history.seeds) largest = std::max(largest, dwell.by(SeedCause::wait).norm());
  return largest;
}

TEST(WaitingSteps, grow_and_add_up_to_the_wait) {
  EXPECT_TRUE(waiting_steps_s(0.0, 0.001).empty());
  for (const double wait_s : {1e-4, 0.001, 0.0014, 0.0021, 1.0, 3600.0, 86400.0}) {
    const std::vector<double> steps = waiting_steps_s(wait_s, 0.001);
    EXPECT_NEAR(std::accumulate(steps.begin(), steps.end(), 0.0), wait_s, 1e-9 * wait_s);
    EXPECT_LT(steps.size(), 200U);
    for (std::size_t k = 1; k < steps.size(); ++k) EXPECT_LE(steps[k], 1.7 * steps[k - 1]);
    for (const double step : steps) EXPECT_GT(step, 0.0);
  }
}

// An exponential approach with these implicit steps is never off by more than two per cent of its whole size.
TEST(WaitingSteps, follow_a_creep_of_any_time_constant) {
  for (const double creep_s : {0.1, 0.6, 10.0, 600.0}) {
    for (const double times : {0.1, 0.5, 1.0, 2.0, 5.0}) {
      double left = 1.0;
      for (const double step_s : waiting_steps_s(times * creep_s, 0.004)) left /= 1.0 + step_s / creep_s;
      EXPECT_NEAR(left, std::exp(-times), 0.025) << creep_s << " " << times;
    }
  }
}

TEST(TemporaryImplant, in_creeping_tissue_moves_dwell_positions_until_the_delivery_and_the_parts_add_up) {
  const ImplantHistory history = simulated_catheters(catheter_scenario(), test::box_patient(), two_catheters());
  ASSERT_EQ(history.seeds.size(), 6U);
  ASSERT_EQ(history.needles.size(), 2U);
  EXPECT_EQ(implant_of(history.seeds), Implant::temporary);
  for (std::size_t k = 0; k < history.seeds.size(); ++k) {
    const SeedHistory& dwell = history.seeds[k];
    EXPECT_EQ(dwell.number, k);
    EXPECT_EQ(dwell.needle, k / 3);
    EXPECT_TRUE(dwell.in_tissue);
    EXPECT_FALSE(dwell.lost);
    ASSERT_TRUE(dwell.at_planning);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& cause : dwell.cause_mm) sum += cause;
    EXPECT_LT((sum - dwell.error_mm()).norm(), 1e-9);
    EXPECT_LT((dwell.by(SeedCause::wait) - (dwell.rest_mm - dwell.at_planning->tissue_mm)).norm(), 1e-9);
    EXPECT_LT((dwell.at_planning->room_mm - dwell.planned_mm - dwell.by(SeedCause::bend)).norm(), 1e-9);
    EXPECT_LT(dwell.error_mm().norm(), 10.0);
    EXPECT_NEAR(dwell.axis.norm(), 1.0, 1e-12);
    EXPECT_GT(dwell.axis.z(), 0.8);
  }
  EXPECT_GT(largest_wait(history), 0.01) << "the tissue creeps";
  // At planning the tissue had less time to creep.
  const ImplantHistory then = history_at_planning(history);
  EXPECT_EQ(largest_wait(then), 0.0);
  for (std::size_t k = 0; k < then.seeds.size(); ++k)
    EXPECT_EQ(then.seeds[k].rest_mm, history.seeds[k].at_planning->tissue_mm);
  // A plan keeps its dwell times.
  const DosePlan delivered = delivered_plan(two_catheters(), history);
  ASSERT_EQ(delivered.sources.size(), 6U);
  EXPECT_EQ(delivered.implant, Implant::temporary);
  EXPECT_EQ(delivered.sources[1].dwell_s, 5.0);
  EXPECT_EQ(delivered.sources[1].needle, "1");
  EXPECT_EQ(delivered.sources[1].at_mm, history.seeds[1].rest_mm);
}

TEST(TemporaryImplant, in_elastic_tissue_does_not_move_between_planning_and_delivery) {
  Scenario s = catheter_scenario();
  s.tissue_model.creep = 1.0;
  const ImplantHistory history = simulated_catheters(s, test::box_patient(), two_catheters());
  EXPECT_LT(largest_wait(history), 1e-9);
  double moved = 0.0;
  for (const SeedHistory& dwell : history.seeds) {
    EXPECT_EQ(dwell.by(SeedCause::relaxation), Vec3::Zero());
    moved = std::max(moved, dwell.by(SeedCause::motion).norm());
  }
  EXPECT_GT(moved, 0.1) << "catheters in place hold the tissue displaced";
}

TEST(TemporaryImplant, without_a_wait_is_delivered_as_it_was_planned) {
  Scenario s = catheter_scenario();
  s.procedure.planning_to_delivery_s = 0.0;
  EXPECT_EQ(largest_wait(simulated_catheters(s, test::box_patient(), two_catheters())), 0.0);
}

TEST(TemporaryImplant, in_tissue_without_friction_and_cutting_force_has_dwell_positions_nearly_where_planned) {
  Scenario s = catheter_scenario();
  s.tissue_model.preset = TissuePreset::linear;
  for (const char* region : {"body", "prostate"}) {
    TissueParameters tissue = default_tissue(region, TissuePreset::linear);
    tissue.puncture_N = 0.0;
    tissue.cutting_N = 1e-4;
    tissue.friction_static_N_per_m = tissue.friction_coulomb_N_per_m = tissue.friction_viscous_Ns_per_m2 = 0.0;
    s.tissue[region] = tissue;
  }
  s.coupling.tip_viscosity_Ns_per_m = 0.01;
  for (const SeedHistory& dwell : simulated_catheters(s, test::box_patient(), two_catheters()).seeds)
    EXPECT_LT(dwell.error_mm().norm(), 0.02);
}

// A wait that is ten times longer than the creep needs ends where one that is a hundred times longer does, so the steps
// that grow lose nothing.
TEST(TemporaryImplant, ends_in_the_same_place_after_any_long_wait) {
  Scenario s = catheter_scenario();
  s.procedure.planning_to_delivery_s = 60.0;
  const ImplantHistory minute = simulated_catheters(s, test::box_patient(), two_catheters());
  s.procedure.planning_to_delivery_s = 36000.0;
  const ImplantHistory hours = simulated_catheters(s, test::box_patient(), two_catheters());
  for (std::size_t k = 0; k < hours.seeds.size(); ++k)
    EXPECT_LT((hours.seeds[k].rest_mm - minute.seeds[k].rest_mm).norm(), 0.02);
}

TEST(TemporaryImplant, holds_all_catheters_whatever_the_key_together_says) {
  Scenario s = catheter_scenario();
  s.coupling.method = CouplingSettings::Method::embedded;
  const ImplantHistory one = simulated_catheters(s, test::box_patient(), two_catheters());
  s.procedure.together = NeedlesTogether::all;
  const ImplantHistory all = simulated_catheters(s, test::box_patient(), two_catheters());
  for (std::size_t k = 0; k < all.seeds.size(); ++k)
    EXPECT_LT((all.seeds[k].rest_mm - one.seeds[k].rest_mm).norm(), 1e-8);
}

TEST(TemporaryImplant, refuses_a_coupling_that_holds_one_needle_only) {
  Scenario s = catheter_scenario();
  s.coupling.method = CouplingSettings::Method::node_addition;
  s.coupling.solver = CouplingSettings::Solver::staggered;
  const auto history = simulate_implant(s, test::box_patient(), load_catheters(two_catheters(), kTip_mm).value(),
                                        kSource_mm, "case.toml");
  ASSERT_FALSE(history.ok());
  EXPECT_SAYS(history.error().message(), "coupling.solver");
}

}  // namespace
}  // namespace stylet

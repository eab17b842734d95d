// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic_implant.hpp"

#include "synthetic_dose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet::testing {
namespace {

/// The number of a needle with this name, which is added where it is new.
std::size_t needle_of(ImplantHistory& history, const PlannedSource& source) {
  const auto found = std::find_if(history.needles.begin(), history.needles.end(),
                                  [&](const NeedleHistory& needle) { return needle.name == source.needle; });
  if (found != history.needles.end()) return static_cast<std::size_t>(found - history.needles.begin());
  NeedleHistory needle;
  needle.name = source.needle;
  needle.entry_mm = Vec3(source.at_mm.x(), source.at_mm.y(), -60.0);
  needle.depth_mm = 85.0;
  needle.peak_force_N = 5.5 + 0.25 * static_cast<double>(history.needles.size());
  needle.deflection_mm = 0.4;
  needle.gland_shift_mm = Vec3(0.1, -0.2, 1.9);
  history.needles.push_back(needle);
  return history.needles.size() - 1;
}

/// A shaft that bends to one side within the patient.
NeedleShape invented_shape(const NeedleHistory& needle, const std::string& when, double time_s) {
  NeedleShape shape{.when = when, .time_s = time_s, .base_depth_mm = needle.depth_mm, .points_mm = {}};
  for (int k = 0; k < kNeedleShapePoints; ++k) {
    const double along = needle.depth_mm - 200.0 + 5.0 * k;
    const double bend = 0.0006 * std::pow(std::max(0.0, along), 2);
    shape.points_mm.push_back(needle.entry_mm + Vec3(bend, -0.4 * bend, along));
  }
  return shape;
}

/// A few steps of a needle on its way in and out, its events and shapes.
void invent_record(NeedleHistory& needle, std::size_t group) {
  needle.record.group = group;
  for (int k = 0; k < 40; ++k) {
    Step& step = needle.record.steps.emplace_back();
    step.time_s = 0.1 * (k + 1);
    step.dt_s = 0.1;
    step.base_depth_mm = needle.depth_mm * (1.0 - std::abs(k - 20) / 20.0);
    step.base.origin = needle.entry_mm + Vec3(0, 0, step.base_depth_mm - 200.0);
    step.force_axial_N = needle.peak_force_N * std::cos(0.1 * k);
    step.tip_mm = step.base.origin + Vec3(0.01 * k, 0, 200.0);
    step.tip_state = k < 20 ? TipState::cutting : TipState::in_track;
    step.contacts = k;
    step.step_us = 50.0 + k;
  }
  needle.steps = 40;
  needle.events = {{EventKind::puncture, 0.3, 12.0, 4.0, "body"}, {EventKind::withdrawn, 4.0, 0.0, -0.5, ""}};
  needle.record.shapes = {invented_shape(needle, "full depth", 2.0), invented_shape(needle, kAllInPlace, 2.5),
                          invented_shape(needle, "seed 3 dropped", 3.0)};
}

/// The D90 of a gland that swells, without a computation.
DoseCourse invented_course() {
  DoseCourse course{.moments = {},
                    .swelling = {.centre_mm = Vec3::Zero(), .at_start = Vec3::Constant(0.145), .half_life_days = 9.3},
                    .half_life_days = 59.4,
                    .samples = 1000};
  for (int k = 0; k <= 16; ++k) {
    const double share = k / 16.0;
    const double taken = 14.0 * (1.0 - std::pow(1.0 - share, 7.4));
    course.moments.push_back(
        {k == 16 ? INFINITY : -59.4 * std::log2(1.0 - share), share, 150.0 * share - taken, 150.0 * share});
  }
  return course;
}

SeedHistory seed_of(const PlannedSource& source, std::size_t number, std::size_t needle) {
  SeedHistory seed;
  seed.number = number;
  seed.needle = needle;
  seed.planned_mm = source.at_mm;
  const double turn = 0.7 * static_cast<double>(number);
  seed.by(SeedCause::bend) = Vec3(0.4 * std::cos(turn), 0.4 * std::sin(turn), -0.1);
  seed.by(SeedCause::motion) = Vec3(0.0, 0.05, 0.6);
  seed.by(SeedCause::relaxation) = Vec3(0.1 * std::sin(turn), 0.1, 1.2 + 0.03 * (source.at_mm.z() - 15.0));
  seed.dropped_mm = seed.planned_mm + seed.by(SeedCause::bend);
  seed.rest_mm = seed.dropped_mm + seed.by(SeedCause::motion) + seed.by(SeedCause::relaxation);
  return seed;
}

/// The seeds at rest as one could have found them: a common shift, an error of each, two seeds that are not found, one
/// that was never dropped.
std::vector<FoundSeed> invented_found_seeds(const ImplantHistory& history) {
  std::vector<FoundSeed> found;
  for (const SeedHistory& seed : history.seeds) {
    if (seed.number == 3 || seed.number == 10 || seed.lost) continue;
    const double turn = 2.3 * static_cast<double>(seed.number);
    const Vec3 error(0.8 * std::cos(turn), 0.7 * std::sin(1.7 * turn), 0.9 * std::cos(2.9 * turn));
    found.push_back({.at_mm = seed.rest_mm + 0.5 * (seed.error_mm() - Vec3(0, 0, 1.7)) + Vec3(0.4, -0.9, -1.5) + error,
                     .where = "found.csv, line " + std::to_string(found.size() + 2)});
  }
  std::reverse(found.begin(), found.end());
  found.push_back({.at_mm = history.seeds.front().rest_mm + Vec3(0, 60, 0), .where = "found.csv, line 43"});
  return found;
}

}  // namespace

void add_invented_found_seeds(ImplantOutcome& outcome) {
  FoundImplant found{.seeds = {.file = "found.csv", .frame_of_reference = "", .seeds = {}, .notes = {}}};
  found.seeds.seeds = invented_found_seeds(outcome.history);
  found.comparison = compare_found(outcome.history, found.seeds.seeds);
  found.dose = found.dose_without_shift = outcome.delivered;
  found.dose.plan = found_plan(outcome.planned.plan, outcome.history, found.seeds.seeds, found.comparison);
  outcome.found = std::move(found);
}

ImplantOutcome synthetic_implant(double grid_mm, double step_mm) {
  ImplantOutcome outcome;
  outcome.scenario.name = "Invented implant of seeds";
  outcome.planned = synthetic_dose(grid_mm, step_mm);
  outcome.delivered = outcome.planned;
  outcome.seed_length_mm = outcome.planned.source.outer_length_mm;
  ImplantHistory& history = outcome.history;
  history.nodes = 3000;
  const std::vector<PlannedSource>& sources = outcome.planned.plan.sources;
  for (std::size_t k = 0; k < sources.size(); ++k)
    history.seeds.push_back(seed_of(sources[k], k, needle_of(history, sources[k])));
  history.seeds.back().lost = true;
  outcome.oedema = invented_course();
  outcome.mesh = {.nodes = {Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(0, 10, 0), Vec3(0, 0, 10)},
                  .tets = {{0, 1, 2, 3}},
                  .tet_region = {0},
                  .regions = {"prostate"}};
  for (std::size_t k = 0; k < history.needles.size(); ++k) invent_record(history.needles[k], k);
  for (const double x : {-15.0, 15.0}) {
    NeedleHistory& needle = history.stabilising.emplace_back();
    needle.name = x < 0.0 ? "stabilising B4" : "stabilising F4";
    needle.entry_mm = Vec3(x, 0.0, -60.0);
    needle.depth_mm = 90.0;
    needle.gland_shift_mm = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());  // as without a gland
    invent_record(needle, 0);
  }
  outcome.delivered.plan = delivered_plan(outcome.planned.plan, history);
  outcome.warnings = {"Needle G3: In 2 of 1900 steps no balance of needle and tissue was found."};
  return outcome;
}

}  // namespace stylet::testing

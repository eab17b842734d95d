// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/coupling_bench.hpp"

#include "stylet/measure/demo.hpp"
#include "stylet/measure/recorded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace stylet::measure {

namespace {

constexpr const char* kNearField = "near-field";
constexpr const char* kNodeAddition = "node-addition";
/// A narrow corridor keeps the time before the first step short on fine meshes. It suffices, because the demo's needle
/// leaves its planned path by less, and elements that touch the corridor extend beyond it.
constexpr double kCorridor_mm = 3.0;

/// One insertion to be simulated.
struct Case {
  CouplingStudy study{};
  Index nodes = 3000;
  std::string method = kNearField;
  std::string element = "auto";
  double spacing_mm = Scenario{}.coupling.spacing_mm;
  double dt_ms = Scenario{}.run.dt_ms;
};

/// All insertions of the benchmark; of each study and method the finest comes first.
std::vector<Case> cases(Index largest, bool mesh_only) {
  std::vector<Case> all;
  for (const char* method : {kNearField, kNodeAddition}) {
    for (const Index nodes : {40000, 10000, 2000, 500}) {
      if (nodes <= largest) all.push_back({.study = CouplingStudy::mesh, .nodes = nodes, .method = method});
    }
  }
  if (mesh_only) return all;
  for (const Index nodes : {2000, 500}) {
    if (nodes <= largest) all.push_back({.study = CouplingStudy::geometry, .nodes = nodes, .element = "p2"});
  }
  const Index middle = std::min<Index>(largest, Case{}.nodes);
  for (const char* method : {kNearField, kNodeAddition}) {
    for (const double spacing : {2.0, 3.0, 4.0, 6.0, 8.0})
      all.push_back({.study = CouplingStudy::spacing, .nodes = middle, .method = method, .spacing_mm = spacing});
  }
  for (const char* method : {kNearField, kNodeAddition}) {
    for (const double dt : {0.25, 0.5, 1.0, 2.0})
      all.push_back({.study = CouplingStudy::time_step, .nodes = middle, .method = method, .dt_ms = dt});
  }
  return all;
}

Scenario scenario_of(const Case& one, double depth_mm) {
  Scenario scenario = demo_scenario();
  scenario.mesh.nodes = one.nodes;
  scenario.tissue_model.element = choice<ElementChoice>(one.element).value();
  scenario.coupling.method = choice<CouplingSettings::Method>(one.method).value();
  scenario.coupling.spacing_mm = one.spacing_mm;
  scenario.coupling.corridor_mm = kCorridor_mm;
  scenario.run.dt_ms = one.dt_ms;
  scenario.insertions.front().depth_mm = depth_mm;
  scenario.output.frames_per_s = 0.0;
  return scenario;
}

/// Finds the depths at which the target begins and ends on the needle's line, measured from the skin.
void find_gland(const Model& model, CouplingRow& row) {
  constexpr double step = 0.05;
  const PlannedInsertion& plan = model.insertions().front();
  const std::vector<int>& target = model.target_regions();
  row.gland_from_mm = row.gland_to_mm = std::numeric_limits<double>::quiet_NaN();
  Index hint = -1;
  for (double depth = step; depth < model.scenario().needle.length_mm; depth += step) {
    const auto at = model.locator().find(plan.entry + depth * plan.direction, hint);
    if (!at) continue;
    hint = at->tet;
    const int region = model.mesh().tet_region[static_cast<std::size_t>(at->tet)];
    if (std::find(target.begin(), target.end(), region) == target.end()) continue;
    if (std::isnan(row.gland_from_mm)) row.gland_from_mm = depth;
    row.gland_to_mm = depth;
  }
}

/// Base depth [mm] of the first puncture of a target region, or of any other region; NaN if there is none.
double puncture_mm(const RecordedRun& run, bool of_target) {
  const TetMesh& mesh = run.model->mesh();
  for (const Event& event : run.summary.events) {
    if (event.kind != EventKind::puncture) continue;
    const auto named = std::find(mesh.regions.begin(), mesh.regions.end(), event.region);
    const std::vector<int>& target = run.model->target_regions();
    const bool is_target = std::find(target.begin(), target.end(), named - mesh.regions.begin()) != target.end();
    if (is_target == of_target) return event.depth_mm;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The steps of a run without the rest after withdrawal, whose zero forces would reduce the mean of any difference.
std::span<const Step> while_moving(std::span<const Step> steps) {
  std::size_t count = steps.size();
  while (count > 1 && steps[count - 2].base.origin == steps.back().base.origin) --count;
  return steps.first(count);
}

/// The precomputed compliance of one mesh, which is the same for every spacing of contacts and every time step.
struct Offline {
  ModelCompliance compliance;
  double seconds = 0.0;
};
using OfflineOf = std::map<std::pair<std::string, std::string>, Offline>;  // method, element

Result<CouplingRow> carry_out(const Case& one, const MeshedAnatomy& anatomy, double depth_mm, OfflineOf& known,
                              KnownTargets& targets, const Progress& progress) {
  CouplingRow row;
  row.study = one.study;
  row.method = one.method;
  row.spacing_mm = one.spacing_mm;
  row.dt_ms = one.dt_ms;
  const Scenario scenario = scenario_of(one, depth_mm);
  const auto start = std::chrono::steady_clock::now();
  const auto before = known.find({one.method, one.element});
  const auto model = Model::compile(scenario, anatomy.mesh, "the demo", {}, progress,
                                    before == known.end() ? std::nullopt : std::optional(before->second.compliance));
  if (!model) return model.error();
  if (before != known.end()) {
    row.offline_s = before->second.seconds;
  } else {
    row.offline_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Offline made{{(*model)->store()->blocks(), {}}, row.offline_s};
    if ((*model)->kernel()) made.compliance.kernel = (*model)->kernel()->numbers();
    if ((*model)->spread()) made.compliance.spread = (*model)->spread()->matrix();
    known[{one.method, one.element}] = std::move(made);
  }
  const auto run = record_run(*model, targets, progress);
  if (!run) return run.error();
  row.element = to_string((*model)->tissue().element());
  row.nodes = (*model)->mesh().node_count();
  row.curve = force_curve(while_moving(run->steps), 1e-3 * one.dt_ms);
  row.peak_N = row.curve.peak_N();
  row.target_shift_mm = run->summary.target_shift_centroid_mm.norm();
  row.skin_mm = puncture_mm(*run, false);
  row.capsule_mm = puncture_mm(*run, true);
  row.step_us = run->summary.step_us_p50;
  find_gland(**model, row);
  for (const RegionReport& region : anatomy.report.regions) {
    if (is_target_region(region.name)) row.surface_mean_mm = region.surface_mean_mm;
  }
  return row;
}

}  // namespace

const char* to_string(CouplingStudy study) {
  switch (study) {
    case CouplingStudy::mesh:
      return "mesh";
    case CouplingStudy::geometry:
      return "geometry";
    case CouplingStudy::spacing:
      return "spacing";
    case CouplingStudy::time_step:
      return "dt";
  }
  return "";
}

Result<std::vector<CouplingRow>> bench_coupling(const CouplingBenchOptions& options, const Progress& progress) {
  std::vector<CouplingRow> rows;
  Index meshed = 0;
  MeshedAnatomy anatomy;
  OfflineOf known;
  std::optional<KnownTargets> targets;
  for (const Case& one : cases(options.largest, options.mesh_only)) {
    if (one.nodes != meshed) {
      meshed = one.nodes;
      known.clear();
      targets.emplace();
      auto made = mesh_demo(one.nodes, progress);
      if (!made) return made.error();
      anatomy = std::move(*made);
    }
    auto row = carry_out(one, anatomy, options.depth_mm, known, *targets, progress);
    if (!row) return row.error();
    // The finest row comes first. The study of geometry is compared with the finest mesh of the study of meshes.
    const auto finest = std::find_if(rows.begin(), rows.end(), [&](const CouplingRow& r) {
      const bool same = one.study == CouplingStudy::geometry ? r.study == CouplingStudy::mesh : r.study == one.study;
      return same && r.method == one.method;
    });
    if (finest != rows.end())
      row->rms_vs_finest_percent = 100.0 * rms_difference_N(row->curve, finest->curve) / finest->peak_N;
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace stylet::measure

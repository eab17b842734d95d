// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/demo_on_meshes.hpp"

#include "stylet/evidence/validate/recorded_run.hpp"
#include "stylet/measure/demo.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace stylet::validate {

namespace {

constexpr double kDepth_mm = 70.0;
/// A narrow corridor keeps the time before the first step short on fine meshes. It suffices, because the demo's needle
/// leaves its planned path by less, and elements that touch the corridor extend beyond it.
constexpr double kCorridor_mm = 3.0;

/// Base depth [mm] of the first puncture of a target region, or of any other region; NaN if there is none.
double puncture_mm(const RecordedRun& run, bool of_target) {
  for (const Event& event : run.summary.events) {
    if (event.kind == EventKind::puncture && is_target_region(event.region) == of_target) return event.depth_mm;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The steps of a run without the rest after withdrawal, whose zero forces would reduce the mean of any difference.
std::span<const Step> while_moving(std::span<const Step> steps) {
  std::size_t count = steps.size();
  while (count > 1 && steps[count - 2].base.origin == steps.back().base.origin) --count;
  return steps.first(count);
}

Result<DemoOnMesh> carry_out(CouplingSettings::Method method, Index nodes, const Progress& progress) {
  Scenario scenario = measure::demo_scenario();
  scenario.mesh.nodes = nodes;
  scenario.coupling.method = method;
  scenario.coupling.corridor_mm = kCorridor_mm;
  scenario.insertions.front().depth_mm = kDepth_mm;
  scenario.output.frames_per_s = 0.0;
  auto anatomy = measure::mesh_demo(nodes, progress);
  if (!anatomy) return anatomy.error();
  const auto model = Model::compile(scenario, std::move(anatomy->mesh), "the demo", {}, progress);
  if (!model) return model.error();
  const auto run = record_run(*model, progress);
  if (!run) return run.error();
  DemoOnMesh row;
  row.method = word(method);
  row.nodes = (*model)->mesh().node_count();
  row.curve = force_curve(while_moving(run->steps), 1e-3 * scenario.run.dt_ms);
  row.peak_N = row.curve.peak_N();
  row.target_shift_mm = run->summary.target_shift_centroid_mm.norm();
  row.skin_mm = puncture_mm(*run, false);
  row.capsule_mm = puncture_mm(*run, true);
  return row;
}

}  // namespace

Result<std::vector<DemoOnMesh>> demo_on_meshes(Index largest, const Progress& progress) {
  std::vector<DemoOnMesh> rows;
  for (const auto method : {CouplingSettings::Method::near_field, CouplingSettings::Method::node_addition}) {
    const std::size_t finest = rows.size();
    for (const Index nodes : {10000, 2000, 500}) {
      if (nodes > largest) continue;
      auto row = carry_out(method, nodes, progress);
      if (!row) return row.error();
      rows.push_back(std::move(*row));
      const ForceCurve& reference = rows[finest].curve;
      rows.back().rms_vs_finest_percent = 100.0 * rms_difference_N(rows.back().curve, reference) / reference.peak_N();
    }
  }
  return rows;
}

}  // namespace stylet::validate

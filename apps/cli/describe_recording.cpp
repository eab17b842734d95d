// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"
#include "table.hpp"

#include "stylet/sim/recorded_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::cli {

namespace {

struct Peaks {
  double axial_N = 0, sagittal_N = 0, lateral_N = 0;
  double depth_mm = 0;
};

/// Largest absolute forces and largest base depth. Computed from the steps, because a run that was killed has no
/// summary.
Peaks peaks_of(const std::vector<Step>& steps) {
  Peaks peaks;
  for (const Step& step : steps) {
    peaks.axial_N = std::max(peaks.axial_N, std::abs(step.force_axial_N));
    peaks.sagittal_N = std::max(peaks.sagittal_N, std::abs(step.force_sagittal_N));
    peaks.lateral_N = std::max(peaks.lateral_N, std::abs(step.force_lateral_N));
    peaks.depth_mm = std::max(peaks.depth_mm, step.base_depth_mm);
  }
  return peaks;
}

Json events_json(const std::vector<Event>& events) {
  Json json = Json::array();
  for (const Event& event : events) {
    json.push_back({{"kind", to_string(event.kind)},
                    {"time_s", event.time_s},
                    {"depth_mm", event.depth_mm},
                    {"force_N", event.force_N},
                    {"region", event.region}});
  }
  return json;
}

std::string events_text(const std::vector<Event>& events) {
  Table table({"event", "region", "time s", "depth mm", "force N"});
  for (const Event& event : events) {
    table.row({to_string(event.kind), event.region, fmt::format("{:.3f}", event.time_s),
               fmt::format("{:.2f}", event.depth_mm), fmt::format("{:.3f}", event.force_N)});
  }
  return table.text();
}

}  // namespace

Description describe(const RunRecording& run) {
  const Peaks peaks = peaks_of(run.steps);
  const double duration_s = run.steps.empty() ? 0 : run.steps.back().time_s;
  const bool finished = run.summary.has_value();
  const std::int64_t step_count = RecordedSteps(run.steps).count();
  const std::int64_t at_rest = step_count - static_cast<std::int64_t>(run.steps.size());
  const std::vector<std::string>& warnings = finished ? run.summary->warnings : run.info.warnings;

  Description out;
  out.json = {
      {"kind", "recording"},
      {"version", run.info.version},
      {"scenario", run.info.scenario_name},
      {"method", run.info.method},
      {"finished", finished},
      {"mesh", {{"nodes", run.mesh.node_count()}, {"tets", run.mesh.tet_count()}}},
      {"steps", step_count},
      {"steps_at_rest", at_rest},
      {"frames", run.frames.size()},
      {"duration_s", duration_s},
      {"depth_max_mm", peaks.depth_mm},
      {"peak_force_N", {{"axial", peaks.axial_N}, {"sagittal", peaks.sagittal_N}, {"lateral", peaks.lateral_N}}},
      {"events", finished ? events_json(run.summary->events) : Json::array()},
      {"warnings", warnings}};

  Facts facts;
  facts.add("kind", "recording of an insertion");
  facts.add("made by", "stylet " + run.info.version);
  facts.add("scenario", run.info.scenario_name);
  facts.add("method", run.info.method);
  facts.add("state", finished ? "finished" : "unfinished: the insertion is still running or was interrupted");
  facts.add("mesh", fmt::format("{} nodes, {} tetrahedra, {} regions", run.mesh.node_count(), run.mesh.tet_count(),
                                run.mesh.regions.size()));
  facts.add("steps", fmt::format("{}{}, {:.2f} s simulated, {} frames", step_count,
                                 at_rest > 0 ? fmt::format(", {} of them at rest", at_rest) : "", duration_s,
                                 run.frames.size()));
  facts.add("largest base depth", fmt::format("{:.1f} mm", peaks.depth_mm));
  facts.add("peak force", fmt::format("axial {:.2f} N, sagittal {:.2f} N, lateral {:.2f} N", peaks.axial_N,
                                      peaks.sagittal_N, peaks.lateral_N));
  out.text = facts.text();
  if (finished) out.text += "\n\n" + events_text(run.summary->events);
  for (const std::string& warning : warnings) out.text += "\n  warning: " + warning;
  return out;
}

}  // namespace stylet::cli

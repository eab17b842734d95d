// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"
#include "table.hpp"

#include "stylet/io/event_words.hpp"
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
  Table table({"event", "time s", "depth mm", "force N"});
  results::EventWords words;
  for (const Event& event : events) {
    const std::string what = words.clause(event);
    if (what.empty()) continue;  // the puncture at the same place has been said
    table.row({what, fmt::format("{:.3f}", event.time_s), fmt::format("{:.2f}", event.depth_mm),
               fmt::format("{:.3f}", event.force_N)});
  }
  return table.text();
}

/// [mm] Mean distance of seeds from their planned places.
double mean_error_mm(const std::vector<SeedHistory>& seeds) {
  double sum = 0.0;
  for (const SeedHistory& seed : seeds) sum += seed.error_mm().norm();
  return seeds.empty() ? 0.0 : sum / static_cast<double>(seeds.size());
}

std::size_t count_of(const RecordedImplant& implant, SeedAct::Kind kind) {
  return static_cast<std::size_t>(
      std::count_if(implant.acts.begin(), implant.acts.end(), [&](const SeedAct& act) { return act.kind == kind; }));
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json moves_json(const std::vector<ProbeMove>& moves) {
  Json json = Json::array();
  for (const ProbeMove& move : moves) {
    json.push_back({{"time_s", move.time_s},
                    {"depth_mm", move.probe.depth_mm ? Json(*move.probe.depth_mm) : Json(nullptr)},
                    {"lift_mm", move.probe.lift_mm},
                    {"tilt_deg", move.probe.tilt_deg},
                    {"roll_deg", move.probe.roll_deg}});
  }
  return json;
}

Json implant_json(const RecordedImplant& implant) {
  const RecordedPlan& plan = implant.plan;
  Json acts = Json::array();
  for (const SeedAct& act : implant.acts) {
    acts.push_back({{"kind", to_string(act.kind)},
                    {"time_s", act.time_s},
                    {"number", act.seed.number + 1},
                    {"needle", plan.needles[act.seed.needle].name},
                    {"planned_mm", act.seed.planned_mm},
                    {"dropped_mm", act.seed.dropped_mm},
                    {"rest_mm", act.seed.rest_mm},
                    {"error_mm", act.seed.error_mm().norm()}});
  }
  const auto score = implant.dose_after(static_cast<std::int64_t>(implant.acts.size()));
  return {
      {"needle", plan.current < 0 ? Json(nullptr) : Json(plan.needles[static_cast<std::size_t>(plan.current)].name)},
      {"implant", plan.implant},
      {"planned_seeds", plan.seeds.size()},
      {"acts", acts},
      {"seeds_at_end", implant.seeds_after(implant.acts.size()).size()},
      {"d90_Gy", score ? finite(score->d90_Gy) : Json(nullptr)},
      {"d90_percent", score ? finite(score->d90_percent) : Json(nullptr)},
      {"v100_percent", score ? finite(score->v100_percent) : Json(nullptr)}};
}

void add_implant(Facts& facts, const RecordedImplant& implant) {
  const RecordedPlan& plan = implant.plan;
  facts.add(
      "plan of seeds",
      fmt::format("{} seeds in {} needles; {}", plan.seeds.size(), plan.needles.size(),
                  plan.current < 0 ? "this needle is beside the plan"
                                   : "this is needle " + plan.needles[static_cast<std::size_t>(plan.current)].name));
  if (!plan.implant.empty()) {
    const ImplantTally& before = plan.before;
    facts.add(
        "implant",
        fmt::format("begun as {}; needles before this one: skin broken {} times, organs entered {}, bone met {}, "
                    "through the far side {}",
                    plan.implant, before.skin_punctures, before.organ_entries, before.bone_contacts, before.exits));
  }
  facts.add("seeds",
            fmt::format("{} of earlier needles, {} dropped, {} taken back", count_of(implant, SeedAct::Kind::earlier),
                        count_of(implant, SeedAct::Kind::dropped), count_of(implant, SeedAct::Kind::taken_back)));
  const std::vector<SeedHistory> seeds = implant.seeds_after(implant.acts.size());
  std::string end = fmt::format("{} seeds in the tissue", seeds.size());
  if (!seeds.empty()) end += fmt::format(", on average {:.1f} mm from their plan", mean_error_mm(seeds));
  if (const auto score = implant.dose_after(static_cast<std::int64_t>(implant.acts.size()))) {
    end += fmt::format("; D90 {:.1f} Gy", score->d90_Gy);
    if (std::isfinite(score->d90_percent)) end += fmt::format(" ({:.1f} %)", score->d90_percent);
  }
  facts.add("at the end", end);
}

std::string acts_text(const RecordedImplant& implant) {
  Table table({"seed", "needle", "what", "time s", "planned x y z mm", "dropped x y z mm", "off mm"});
  const auto place = [](const Vec3& x) { return fmt::format("{:.1f} {:.1f} {:.1f}", x.x(), x.y(), x.z()); };
  for (const SeedAct& act : implant.acts) {
    table.row({fmt::format("{}", act.seed.number + 1), implant.plan.needles[act.seed.needle].name,
               act.kind == SeedAct::Kind::taken_back ? "taken back" : to_string(act.kind),
               fmt::format("{:.2f}", act.time_s), place(act.seed.planned_mm), place(act.seed.dropped_mm),
               fmt::format("{:.1f}", act.seed.error_mm().norm())});
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
      {"ended", run.has_ended},
      {"mesh", {{"nodes", run.mesh.node_count()}, {"tets", run.mesh.tet_count()}}},
      {"steps", step_count},
      {"steps_at_rest", at_rest},
      {"frames", run.frames.size()},
      {"duration_s", duration_s},
      {"depth_max_mm", peaks.depth_mm},
      {"peak_force_N", {{"axial", peaks.axial_N}, {"sagittal", peaks.sagittal_N}, {"lateral", peaks.lateral_N}}},
      {"events", finished ? events_json(run.summary->events) : Json::array()},
      {"warnings", warnings}};

  if (!run.probe_moves.empty()) out.json["probe_moves"] = moves_json(run.probe_moves);
  if (run.implant) out.json["implant"] = implant_json(*run.implant);

  Facts facts;
  facts.add("kind", "recording of an insertion");
  facts.add("made by", "stylet " + run.info.version);
  facts.add("scenario", run.info.scenario_name);
  facts.add("method", run.info.method);
  facts.add("state", finished        ? "finished"
                     : run.has_ended ? "ended: another needle was taken up, or the session was closed"
                                     : "unfinished: the insertion is still running or was interrupted");
  facts.add("mesh", fmt::format("{} nodes, {} tetrahedra, {} regions", run.mesh.node_count(), run.mesh.tet_count(),
                                run.mesh.regions.size()));
  facts.add("steps", fmt::format("{}{}, {:.2f} s simulated, {} frames", step_count,
                                 at_rest > 0 ? fmt::format(", {} of them at rest", at_rest) : "", duration_s,
                                 run.frames.size()));
  facts.add("largest base depth", fmt::format("{:.1f} mm", peaks.depth_mm));
  facts.add("peak force", fmt::format("axial {:.2f} N, sagittal {:.2f} N, lateral {:.2f} N", peaks.axial_N,
                                      peaks.sagittal_N, peaks.lateral_N));
  if (!run.probe_moves.empty())
    facts.add("probe", fmt::format("recorded at {} place{}, at the end lifted by {:g} mm", run.probe_moves.size(),
                                   run.probe_moves.size() == 1 ? "" : "s", run.probe_moves.back().probe.lift_mm));
  if (run.implant) add_implant(facts, *run.implant);
  out.text = facts.text();
  if (run.implant && !run.implant->acts.empty()) out.text += "\n\n" + acts_text(*run.implant);
  if (finished) out.text += "\n\n" + events_text(run.summary->events);
  for (const std::string& warning : warnings) out.text += "\n  warning: " + warning;
  return out;
}

}  // namespace stylet::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

// Measured on two shared cores (docs/realtime.md, docs/scenario.md); the estimate is right within a factor of three.
constexpr double kStep_s = 2e-4;           ///< a step with its recording, with the default coupling
constexpr double kOtherStep_s = 2e-3;      ///< a step with another solver, engine, method or needle model
constexpr double kPreparation_s = 1.4e-3;  ///< meshing, factor and compliance, for each node
constexpr double kInverse_s = 2e-10;       ///< full inverse of the engines woodbury and bcs, for each (3 nodes)³
constexpr double kMemory_GB = 6e-5;        ///< of factor and compliance, for each node
constexpr double kLong_s = 900.0;
constexpr double kMuchMemory_GB = 12.0;
constexpr double kDepth_mm = 100.0;      ///< of a needle whose depth is found in the mesh
constexpr double kNeedlesOfFile = 20.0;  ///< of a plan that has not been read

bool is_default_coupling(const Scenario& s) {
  const Scenario::Coupling fresh;
  return s.coupling.method == fresh.method && s.coupling.solver == fresh.solver && s.coupling.engine == fresh.engine &&
         s.needle.model == NeedleModel::beam;
}

/// [s] Simulated time of the insertions, or of the needles of the plan.
double simulated_s(const Scenario& s) {
  double total = 0.0;
  for (const InsertionPlan& p : s.insertions) {
    if (!p.motion.empty()) continue;
    const double way = p.approach_mm + (p.depth_mm > 0.0 ? p.depth_mm : kDepth_mm);
    total += way / p.speed_mm_per_s + p.dwell_s + (p.retract ? way / p.retract_speed_mm_per_s : 0.0);
  }
  if (!s.insertions.empty() || !s.plan.is_given()) return total;
  const double needles = s.plan.needles.empty() ? kNeedlesOfFile : static_cast<double>(s.plan.needles.size());
  const Scenario::Procedure& p = s.procedure;
  return needles * kDepth_mm * (1.0 / p.speed_mm_per_s + 0.5 / p.drop_speed_mm_per_s + 0.5 / p.retract_speed_mm_per_s);
}

std::string duration_text(double seconds) {
  if (seconds < 5400.0) return fmt::format("{:.0f} minutes", std::max(1.0, seconds / 60.0));
  if (seconds < 172800.0) return fmt::format("{:.1f} hours", seconds / 3600.0);
  return fmt::format("{:.0f} days", seconds / 86400.0);
}

}  // namespace

WorkEstimate estimate_work(const Scenario& s, double recorded_s) {
  WorkEstimate work;
  work.steps = (simulated_s(s) + recorded_s) / (1e-3 * s.run.dt_ms);
  const double nodes = s.mesh.nodes > 0 ? s.mesh.nodes : s.mesh.preset == MeshPreset::paper ? 570.0 : 3000.0;
  work.seconds = kPreparation_s * nodes + (is_default_coupling(s) ? kStep_s : kOtherStep_s) * work.steps;
  if (s.coupling.engine != CouplingSettings::Engine::condensed) work.seconds += kInverse_s * std::pow(3.0 * nodes, 3);
  work.memory_GB = kMemory_GB * nodes;
  return work;
}

std::string long_work_warning(const Scenario& s, double recorded_s) {
  const WorkEstimate work = estimate_work(s, recorded_s);
  const bool much = work.memory_GB > kMuchMemory_GB;
  if (work.seconds <= kLong_s && !much) return {};
  const std::string memory = much ? fmt::format(" and {:.0f} GB of memory", work.memory_GB) : "";
  const WorkEstimate none = [&] {
    Scenario still = s;
    still.run.dt_ms = 1e9;
    return estimate_work(still);
  }();
  const bool steps_take_it = work.seconds > 2.0 * none.seconds;
  return fmt::format("This will take about {}{}: {:.3g} steps of {:g} ms, and a mesh of {} nodes. {}. Ctrl-C ends it.",
                     duration_text(work.seconds), memory, work.steps, s.run.dt_ms,
                     s.mesh.nodes > 0 ? fmt::to_string(s.mesh.nodes) : "the default number of",
                     steps_take_it ? "A larger speed, a shorter pause or a larger run.dt_ms makes it shorter"
                                   : "Fewer nodes (mesh.nodes) make it shorter");
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

// Measured on two shared cores (docs/scenario.md); the estimate is right within a factor of three.
constexpr double kStep_s = 2e-4;           ///< a step with its recording, with the default coupling
constexpr double kOtherStep_s = 2e-3;      ///< a step with another solver, engine, method or needle model
constexpr double kPreparation_s = 6e-3;    ///< meshing, factor, compliance and motion of the target, for each node
constexpr double kNextNeedle_s = 1e-3;     ///< path of another needle in the same tissue, for each node
constexpr double kInverse_s = 2e-10;       ///< full inverse of the engines woodbury and bcs, for each (3 nodes)³
constexpr double kInsertResults_s = 15.0;  ///< files and pictures
constexpr double kImplantResults_s = 35.0;
constexpr double kProgram_GB = 0.5;         ///< libraries, files and pictures
constexpr double kNode_GB = 4e-5;           ///< mesh, factor and compliance, for each node
constexpr double kNodePair_GB = 7e-9;       ///< parts that grow faster, for each nodes²
constexpr double kImplantNode_GB = 1.6e-4;  ///< kept states of the needles of an implant, for each node
constexpr double kLong_s = 900.0;
constexpr double kMuchMemory_GB = 12.0;
constexpr double kDepth_mm = 100.0;      ///< of a needle whose depth is found in the mesh
constexpr double kNeedlesOfFile = 20.0;  ///< of a plan that has not been read

bool is_default_coupling(const Scenario& s) {
  const Scenario::Coupling fresh;
  return s.coupling.method == fresh.method && s.coupling.solver == fresh.solver && s.coupling.engine == fresh.engine &&
         s.needle.model == NeedleModel::beam;
}

bool is_implant(const Scenario& s) { return s.insertions.empty() && s.plan.is_given(); }

double needles_of(const Scenario& s) {
  if (!is_implant(s)) return static_cast<double>(std::max<std::size_t>(1, s.insertions.size()));
  return s.plan.needles.empty() ? kNeedlesOfFile : static_cast<double>(s.plan.needles.size());
}

/// [s] Simulated time of the insertions, or of the needles of the plan.
double simulated_s(const Scenario& s) {
  double total = 0.0;
  for (const InsertionPlan& p : s.insertions) {
    if (!p.motion.empty()) continue;
    const double way = p.approach_mm + (p.depth_mm > 0.0 ? p.depth_mm : kDepth_mm);
    total += way / p.speed_mm_per_s + p.dwell_s + (p.retract ? way / p.retract_speed_mm_per_s : 0.0);
  }
  if (!is_implant(s)) return total;
  const Scenario::Procedure& p = s.procedure;
  return needles_of(s) * kDepth_mm *
         (1.0 / p.speed_mm_per_s + 0.5 / p.drop_speed_mm_per_s + 0.5 / p.retract_speed_mm_per_s);
}

std::string duration_text(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} seconds", std::max(1.0, seconds));
  if (seconds < 5400.0) return fmt::format("{:.0f} minutes", std::max(1.0, seconds / 60.0));
  if (seconds < 172800.0) return fmt::format("{:.1f} hours", seconds / 3600.0);
  return fmt::format("{:.0f} days", seconds / 86400.0);
}

}  // namespace

WorkEstimate estimate_work(const Scenario& s, double recorded_s) {
  WorkEstimate work;
  work.steps = (simulated_s(s) + recorded_s) / (1e-3 * s.run.dt_ms);
  const double nodes = s.mesh.nodes > 0 ? s.mesh.nodes : s.mesh.preset == MeshPreset::paper ? 570.0 : 3000.0;
  work.preparation_s = kPreparation_s * nodes;
  if (s.coupling.engine != CouplingSettings::Engine::condensed)
    work.preparation_s += kInverse_s * std::pow(3.0 * nodes, 3);
  work.seconds = work.preparation_s + (needles_of(s) - 1.0) * kNextNeedle_s * nodes +
                 (is_default_coupling(s) ? kStep_s : kOtherStep_s) * work.steps +
                 (is_implant(s) ? kImplantResults_s : kInsertResults_s);
  work.memory_GB = kProgram_GB + (kNode_GB + kNodePair_GB * nodes + (is_implant(s) ? kImplantNode_GB : 0.0)) * nodes;
  return work;
}

std::string work_text(double seconds, double memory_GB) {
  return fmt::format("about {} of processor time and {:.1f} GB of memory", duration_text(seconds), memory_GB);
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

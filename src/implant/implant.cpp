// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/implant.hpp"

#include "needle_motion.hpp"
#include "seed_fate.hpp"
#include "seed_watch.hpp"
#include "sim/base_steps.hpp"
#include "stylet/core/flush_denormals.hpp"
#include "stylet/core/parallel.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/implant/needle_insertion.hpp"
#include "stylet/sim/harms.hpp"
#include "stylet/sim/prediction.hpp"
#include "stylet/sim/target_motion.hpp"
#include "stylet/sim/unbroken_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <limits>
#include <mutex>
#include <thread>

namespace stylet {

namespace {

/// Largest total number of nodes of the meshes whose models are compiled in parallel; it limits the memory.
constexpr Index kNodesAtOnce = 40000;
constexpr int kGlandEvery = 8;  ///< steps between two looks at the gland

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct OneNeedle {
  NeedleHistory needle;
  std::vector<SeedHistory> seeds;
  std::vector<std::string> warnings;
  double compile_s = 0.0;
};

/// Compiles the model of one needle and carries out its procedure.
Result<OneNeedle> insert_needle(const NeedleLoad& load, const InsertionPlan& plan, Scenario scenario,
                                const TetMesh& mesh, double seed_length_mm, KnownTargets& targets,
                                const std::string& where) {
  OneNeedle out;
  const Vec3 entry(plan.entry_mm->data());
  const NeedleMotion motion = plan_needle_motion(load, entry, scenario, seed_length_mm);
  scenario.insertions = {plan};
  const double start = wall_s();
  auto compiled = Model::compile(scenario, mesh, fmt::format("{}, needle {}", where, load.name));
  if (!compiled) return compiled.error();
  const std::shared_ptr<const Model> model = *std::move(compiled);
  std::optional<TargetMotion> gland;
  if (!model->target_regions().empty()) {
    auto response = targets.of(model, {});
    if (!response) return response.error();
    gland.emplace(*std::move(response));
  }
  out.compile_s = wall_s() - start;

  const FlushDenormals flush;  // as in run(), so that the results are equal
  Simulation simulation(model);
  simulation.place(motion.insertion);
  SeedWatch seeds(load, motion, scenario, seed_length_mm);
  UnbrokenSurface unbroken;
  const BaseSteps steps = planned_steps(*model, motion.insertion);
  NeedleHistory& needle = out.needle;
  needle.name = load.name;
  needle.entry_mm = entry;
  needle.direction = load.direction;
  needle.depth_mm = motion.insertion.depth_mm;
  long without_balance = 0;
  for (long k = 1; k <= steps.count; ++k) {
    simulation.prepare();
    const double before = thread_cpu_s();
    const Step& step = simulation.step(steps.base(k), steps.dt_s(k));
    needle.seconds += thread_cpu_s() - before;
    ++needle.steps;
    if ((step.flags & Step::kDistrusted) != 0) ++without_balance;
    needle.peak_force_N = std::max(needle.peak_force_N, std::abs(step.force_axial_N));
    if (step.tip_state != TipState::air) {
      const Vec3 off = step.tip_mm - entry;
      needle.deflection_mm = std::max(needle.deflection_mm, (off - load.direction * load.direction.dot(off)).norm());
    }
    seeds.add(simulation, simulation.time_s());
    unbroken.add(simulation);
    for (const Event& event : simulation.new_events()) needle.events.push_back(event);
    if (gland && k % kGlandEvery == 0) {
      const Vec3 shift = gland->now(simulation.insertion()).motion.shift_mm;
      if (shift.norm() > needle.gland_shift_mm.norm()) needle.gland_shift_mm = shift;
    }
  }
  if (!gland) needle.gland_shift_mm.setConstant(std::numeric_limits<double>::quiet_NaN());
  out.seeds = seeds.result();
  const auto warn = [&](const std::string& text) {
    out.warnings.push_back(fmt::format("Needle {}: {}", load.name, text));
  };
  for (const std::string& harm : harms(needle.events)) warn(harm);
  if (auto warning = unbroken.warning()) warn(*warning);
  if (without_balance > 0) {
    warn(fmt::format("In {} of {} steps no balance of needle and tissue was found; a smaller run.dt_ms helps.",
                     without_balance, needle.steps));
  }
  const auto astray =
      std::count_if(out.seeds.begin(), out.seeds.end(), [](const SeedHistory& s) { return !s.in_tissue; });
  if (astray > 0) {
    warn(fmt::format(
        "{} of its {} seeds were not dropped in tissue whose displacement is known; they stay where they were "
        "dropped.",
        astray, out.seeds.size()));
  }
  if (load.beside_line_mm > 1.0) {
    warn(fmt::format("Its planned seeds lie up to {:.1f} mm beside a straight line; the needle is straight.",
                     load.beside_line_mm));
  }
  return out;
}

}  // namespace

const char* to_string(SeedCause cause) {
  switch (cause) {
    case SeedCause::bend:
      return "needle bend";
    case SeedCause::motion:
      return "tissue motion";
    case SeedCause::relaxation:
      return "tissue relaxation";
    case SeedCause::strand:
      return "strand";
    case SeedCause::release:
      return "release";
    case SeedCause::aim:
      return "aim";
  }
  return "";
}

Result<ImplantHistory> simulate_implant(const Scenario& scenario, const TetMesh& mesh,
                                        const std::vector<NeedleLoad>& needles, double seed_length_mm,
                                        const std::string& where, const Progress& progress) {
  const Topology topology(mesh);
  const Locator locator(mesh, topology);
  std::vector<InsertionPlan> plans;
  for (const NeedleLoad& load : needles) {
    Result<InsertionPlan> plan = needle_insertion(load, scenario, locator, where);
    if (!plan) return plan.error();
    plans.push_back(*std::move(plan));
  }
  KnownTargets targets;
  std::vector<std::optional<Result<OneNeedle>>> done(needles.size());
  const auto caller = std::this_thread::get_id();
  const auto lanes = static_cast<std::size_t>(std::max<Index>(1, kNodesAtOnce / std::max<Index>(1, mesh.node_count())));
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> finished = 0;
  std::atomic<bool> failed = false;
  for_each_in_parallel(std::min(lanes, needles.size()), [&](std::size_t /*lane*/) {
    for (std::size_t k = next++; k < needles.size() && !failed; k = next++) {
      if (std::this_thread::get_id() == caller) {
        report(progress, fmt::format("needle {} of {}, {}", k + 1, needles.size(), needles[k].name),
               static_cast<double>(finished) / static_cast<double>(needles.size()));
      }
      done[k] = insert_needle(needles[k], plans[k], scenario, mesh, seed_length_mm, targets, where);
      if (!done[k]->ok()) failed = true;
      ++finished;
    }
  });
  ImplantHistory history;
  history.nodes = static_cast<int>(mesh.node_count());
  for (std::size_t k = 0; k < needles.size(); ++k) {
    if (!done[k]) continue;
    if (!done[k]->ok()) return done[k]->error();
    OneNeedle& one = **done[k];
    settle_seeds(one.seeds, scenario.seed, k);
    for (SeedHistory& seed : one.seeds) {
      seed.needle = k;
      history.seeds.push_back(seed);
    }
    history.needles.push_back(std::move(one.needle));
    history.warnings.insert(history.warnings.end(), one.warnings.begin(), one.warnings.end());
    history.compile_s += one.compile_s;
  }
  std::sort(history.seeds.begin(), history.seeds.end(),
            [](const SeedHistory& a, const SeedHistory& b) { return a.number < b.number; });
  return history;
}

}  // namespace stylet

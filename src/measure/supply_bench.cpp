// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/supply_bench.hpp"

#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/realtime/steppable.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace stylet::measure {

namespace {

constexpr double kBeside_mm = 18.0;
constexpr double kFrom_mm = -5.0;
constexpr double kTo_mm = 40.0;
constexpr double kStep_s = 1e-3;

/// Poses of the base in all steps.
std::vector<Pose> way_beside(const Model& model, double speed_mm_per_s) {
  const PlannedInsertion& plan = model.insertions().front();
  const Pose planned = plan.motion.at(0.0);
  const Vec3 tip = planned.origin + model.scenario().needle.length_mm * plan.direction;
  const Vec3 beside = plan.direction.cross(plan.direction.unitOrthogonal());
  const long steps = std::lround((kTo_mm - kFrom_mm) / (speed_mm_per_s * kStep_s));
  std::vector<Pose> way;
  for (long k = 0; k <= steps; ++k) {
    const double depth = kFrom_mm + (kTo_mm - kFrom_mm) * static_cast<double>(k) / static_cast<double>(steps);
    Pose pose = planned;
    pose.origin += kBeside_mm * beside + (depth - (tip - plan.entry).dot(plan.direction)) * plan.direction;
    way.push_back(pose);
  }
  return way;
}

void place(Simulation& simulation, const Pose& base) {
  const PlannedInsertion& plan = simulation.model().insertions().front();
  simulation.place(base, plan.entry, plan.direction);
  simulation.prepare();
}

/// Axial forces when each step waits for its compliance.
std::vector<double> forces_without_haste(const std::shared_ptr<const Model>& model, const std::vector<Pose>& way) {
  Simulation simulation(model);
  place(simulation, way.front());
  std::vector<double> forces;
  for (const Pose& base : way) {
    simulation.prepare();
    forces.push_back(simulation.step(base, kStep_s).force_axial_N);
  }
  return forces;
}

SupplyRow measure(const std::shared_ptr<const Model>& model, double speed_mm_per_s) {
  using Clock = std::chrono::steady_clock;
  SupplyRow row;
  row.nodes = model->mesh().node_count();
  row.element = to_string(model->tissue().element());
  row.prepared = model->store()->stored_nodes();
  row.speed_mm_per_s = speed_mm_per_s;
  const std::vector<Pose> way = way_beside(*model, speed_mm_per_s);
  const std::vector<double> expected = forces_without_haste(model, way);

  SimulationSteppable body(model);
  Simulation& simulation = body.simulation();
  place(simulation, way.front());
  const std::uint64_t before = simulation.insertion().store().arrived();
  const Clock::time_point begin = Clock::now();
  for (std::size_t k = 0; k < way.size(); ++k) {
    std::this_thread::sleep_until(begin + k * std::chrono::milliseconds(1));
    const double cpu = measure::thread_cpu_s();
    body.step(way[k], kStep_s);
    row.longest_cpu_us = std::max(row.longest_cpu_us, 1e6 * (measure::thread_cpu_s() - cpu));
    const bool flagged = simulation.last_step().flags != 0;
    if (!flagged && simulation.last_step().tip_state == TipState::air) continue;
    ++row.steps;
    row.flagged += flagged ? 1 : 0;
    row.force_off_N = std::max(row.force_off_N, std::abs(simulation.last_step().force_axial_N - expected[k]));
    row.force_peak_N = std::max(row.force_peak_N, expected[k]);
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  row.rows = static_cast<long>(simulation.insertion().store().arrived() - before);
  row.rows_per_s = static_cast<double>(row.rows) / seconds;
  return row;
}

}  // namespace

Result<std::vector<SupplyRow>> bench_supply(const SupplyBenchOptions& options, const Progress& progress) {
  static_assert(kStep_s == 1e-3, "the clock's milliseconds");
  std::vector<SupplyRow> rows;
  for (const Index nodes : {570, 5000, 20000, 100000}) {
    if (nodes > options.largest) continue;
    const auto anatomy = mesh_demo(nodes, progress);
    if (!anatomy) return anatomy.error();
    const auto model = Model::compile(demo_scenario(), anatomy->mesh, "the demo", {}, progress);
    if (!model) return model.error();
    for (std::size_t k = 0; k < options.speeds_mm_per_s.size(); ++k) {
      report(progress, "beside the corridor",
             static_cast<double>(k) / static_cast<double>(options.speeds_mm_per_s.size()));
      rows.push_back(measure(*model, options.speeds_mm_per_s[k]));
    }
  }
  return rows;
}

}  // namespace stylet::measure

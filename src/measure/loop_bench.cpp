// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/loop_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/realtime/scripted_device.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace stylet::measure {

Result<LoopReport> bench_loop(const LoopBenchOptions& options, const Progress& progress) {
  const auto anatomy = mesh_demo(options.nodes, progress);
  if (!anatomy) return anatomy.error();
  const auto model = Model::compile(driven_scenario(options.contacts), anatomy->mesh, "the demo", {}, progress);
  if (!model) return model.error();

  auto body = std::make_unique<SimulationSteppable>(*model);
  const double start_mm = body->simulation().last_step().base_depth_mm;
  auto device =
      std::make_unique<ScriptedDevice>(driven_motion((*model)->insertions().front(), start_mm, options.seconds + 1.0));
  auto runner = RealtimeRunner::create(std::move(body), std::move(device), RunnerSettings{});
  if (!runner) return runner.error();

  LoopReport report;
  report.nodes = (*model)->mesh().node_count();
  using Clock = std::chrono::steady_clock;
  if (auto started = (*runner)->start(); !started) return started.error();
  const Clock::time_point begin = Clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  while (passed() < options.seconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(16));  // as a display does
    (*runner)->fetch_snapshot();
    report.contacts_max = std::max(report.contacts_max, (*runner)->snapshot().contact_count);
    stylet::report(progress, "real time", passed() / options.seconds);
  }
  report.seconds = passed();
  (*runner)->stop();
  (*runner)->fetch_snapshot();
  report.simulated_s = (*runner)->snapshot().step.time_s;
  report.counters = (*runner)->snapshot().counters;
  report.times = *(*runner)->times();
  report.rights = (*runner)->rights();
  return report;
}

}  // namespace stylet::measure

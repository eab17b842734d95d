// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/validate/loop_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/realtime/scripted_device.hpp"
#include "stylet/validate/context.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace stylet::validate {

namespace {

/// The way of the needle, again and again for so long.
BaseMotion hand(const PlannedInsertion& plan, double start_mm, double seconds) {
  const std::vector<double> way = driven_depths(start_mm);
  const Pose first = plan.motion.at(0.0);
  std::vector<MotionSample> samples{{0.0, first}};
  for (double time_s = 0.0; time_s < seconds;) {
    for (const double depth : way) {
      Pose base = first;
      base.origin += (depth - start_mm) * plan.direction;
      time_s += kDrivenStep_s;
      samples.push_back({time_s, base});
    }
  }
  return BaseMotion(std::move(samples));
}

}  // namespace

Result<LoopReport> bench_loop(const LoopBenchOptions& options, const Progress& progress) {
  const auto anatomy = mesh_demo(options.nodes, progress);
  if (!anatomy) return anatomy.error();
  const auto model = Model::compile(driven_scenario(options.contacts), anatomy->mesh, "the demo", {}, progress);
  if (!model) return model.error();

  auto body = std::make_unique<SimulationSteppable>(*model);
  const double start_mm = body->simulation().record().base_depth_mm;
  auto device = std::make_unique<ScriptedDevice>(hand((*model)->insertions().front(), start_mm, options.seconds + 1.0));
  auto runner = RealtimeRunner::create(std::move(body), std::move(device), RunnerSettings{});
  if (!runner) return runner.error();

  LoopReport report;
  report.nodes = (*model)->mesh().node_count();
  using Clock = std::chrono::steady_clock;
  if (auto started = (*runner)->start(); !started) return started.error();
  const Clock::time_point begin = Clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  while (passed() < options.seconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(16));  // as a display would
    (*runner)->fetch_snapshot();
    report.contacts_max = std::max(report.contacts_max, (*runner)->snapshot().contact_count);
    stylet::report(progress, "real time", passed() / options.seconds);
  }
  report.seconds = passed();
  (*runner)->stop();
  (*runner)->fetch_snapshot();
  report.simulated_s = (*runner)->snapshot().time_s;
  report.counters = (*runner)->snapshot().counters;
  report.times = *(*runner)->times();
  report.rights = (*runner)->rights();
  return report;
}

}  // namespace stylet::validate

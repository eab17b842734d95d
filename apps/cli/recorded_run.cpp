// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorded_run.hpp"

#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/recorded_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace stylet::cli {

namespace {

using Forces = std::array<double, 6>;

Forces forces(const Step& s) {
  return {s.force_axial_N, s.force_sagittal_N, s.force_lateral_N, s.torque_Nmm.x(), s.torque_Nmm.y(), s.torque_Nmm.z()};
}

bool same_bits(const Forces& a, const Forces& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

}  // namespace

Result<RecordedRun> recorded_run(const std::string& file, const std::vector<std::string>& settings,
                                 const Progress& progress) {
  if (auto checked = check_settings(settings, file); !checked) return checked.error();
  auto recording = read_recording(file);
  if (!recording) return recording.error();
  if (recording->steps.empty())
    return input_error(file, "the recording ends before its first step", "Choose another recording");
  auto scenario = parse_scenario(recording->info.scenario_text, file + ", /scenario", settings);
  if (!scenario) return scenario.error();
  const auto start = std::chrono::steady_clock::now();
  auto model = Model::compile(*scenario, std::move(recording->mesh), file, {}, progress);
  if (!model) return model.error();
  RecordedRun run;
  run.steps = std::move(recording->steps);
  run.prepared.model = std::move(*model);
  const auto& of_model = run.prepared.model->warnings();
  for (const std::string& warning : recording->info.warnings) {
    if (std::find(of_model.begin(), of_model.end(), warning) != of_model.end()) continue;
    run.prepared.notes.push_back(settings.empty() ? warning : "Warning stored in the recording: " + warning);
  }
  run.prepared.model_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

std::string compare_forces(std::span<const Step> recorded, std::span<const Step> repeated) {
  const RecordedSteps all(recorded);
  const std::size_t count = std::min(static_cast<std::size_t>(all.count()), repeated.size());
  std::size_t differ = 0;
  std::size_t at_rest = 0;
  double first_s = 0.0;
  double most_N = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const Step before = all.at(static_cast<std::int64_t>(k));
    const Forces a = forces(before);
    const Forces b = forces(repeated[k]);
    const bool is_counted_only = !all.is_recorded(static_cast<std::int64_t>(k));
    if (is_counted_only) ++at_rest;
    Step again = repeated[k];
    again.flags = before.flags;  // forces are compared; recordings of earlier versions have no flags
    if (is_counted_only ? is_at_rest(before, again) : same_bits(a, b)) continue;
    if (differ++ == 0) first_s = before.time_s;
    for (std::size_t c = 0; c < 3; ++c) most_N = std::max(most_N, std::abs(a[c] - b[c]));
  }
  if (differ == 0 && static_cast<std::size_t>(all.count()) == repeated.size())
    return fmt::format("the forces of all {} steps are those of the recording, to the last bit{}", count,
                       at_rest == 0 ? ""
                                    : fmt::format("; {} of them were at rest, which it only counts, and stayed so to "
                                                  "{:g} N",
                                                  at_rest, kRestForce_N));
  return fmt::format("the forces of {} of {} steps differ from the recording's, first at {:.3f} s, by at most {:.3g} N",
                     differ, count, first_s, most_N);
}

}  // namespace stylet::cli

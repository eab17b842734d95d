// SPDX-License-Identifier: GPL-3.0-or-later
// Results must not depend on the time step or on the solver's tolerance.
#include "../rows.hpp"
#include "../scene.hpp"
#include "stylet/evidence/validate/force_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

Finding force_over_time_steps(Context&) {
  const auto model = need(Block().compile());
  std::vector<ForceCurve> forces;
  Finding finding;
  finding.plot = {.x_label = "time [s]", .y_label = "axial force [N]"};
  finding.value = 0.0;
  std::string each;
  for (const double dt : {0.25e-3, 0.5e-3, 1e-3, 2e-3}) {
    Drive drive(model);
    drive.go(55.0, 20.0, dt);
    drive.wait(0.1, dt);
    drive.go(-1.0, 20.0, dt);
    ForceCurve& force = forces.emplace_back(ForceCurve{.dt_s = dt, .force_N = {}});
    for (const DriveStep& step : drive.steps()) force.force_N.push_back(step.record.force_axial_N);
    Curve curve{.label = fmt::format("{:g} ms", 1e3 * dt)};
    const auto every = static_cast<std::size_t>(std::lround(2e-3 / dt));
    for (std::size_t k = every; k <= force.force_N.size(); k += every)
      curve.add(static_cast<double>(k) * dt, force.force_N[k - 1]);
    finding.plot.curves.push_back(std::move(curve));
    if (forces.size() == 1) continue;
    const double rms = 100.0 * rms_difference_N(force, forces.front()) / forces.front().peak_N();
    finding.value = worse(finding.value, rms);
    each += fmt::format("{}{:.2f} % at {:g} ms", each.empty() ? "" : ", ", rms, 1e3 * dt);
  }
  finding.note =
      "In through skin and capsule, a pause, and out. RMS difference from the run with 0.25 ms, relative to the "
      "peak: " +
      each + ".";
  finding.why_missed = "The punctures happen at slightly different times.";
  return finding;
}

/// Largest displacement of the tissue by the friction of a needle that goes in.
struct Drag {
  double largest_mm = 0.0;
  unsigned flags = 0;
};
Drag drag(double tolerance, double dt_s) {
  Block block = Block::of_one_tissue();
  block.scenario.coupling.tolerance = tolerance;
  Drive drive(need(block.compile()));
  drive.go(40.0, 20.0, dt_s);
  return Drag{drive.insertion().displacement().cwiseAbs().maxCoeff(), drive.flags()};
}

/// Measures how the drag depends on a setting. @param over the varied setting, as label of the plot
Finding drag_over(const std::string& over, const std::vector<double>& values,
                  const std::function<Drag(double)>& measure) {
  Finding finding;
  Curve curve{.label = "ours"};
  for (const double value : values) {
    const auto found = measure(value);
    curve.add(value, found.largest_mm);
  }
  const auto [low, high] = std::minmax_element(curve.y.begin(), curve.y.end());
  finding.value = 100.0 * (*high - *low) / *high;
  finding.note = fmt::format(
      "A needle goes 40 mm in, with the same friction in each run. The largest displacement of the tissue is "
      "{:.4f} … {:.4f} mm.",
      *low, *high);
  finding.plot = {
      .x_label = over, .y_label = "largest displacement of the tissue [mm]", .log_x = true, .curves = {curve}};
  return finding;
}

Finding drag_over_tolerance(Context&) {
  auto finding = drag_over("tolerance of the solver", {1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5},
                           [](double tolerance) { return drag(tolerance, 1e-3); });
  finding.plot.log_y = true;
  finding.plot.curves.push_back(
      {.label = "SOFA’s needle plugin", .x = {1e-9, 1e-5}, .y = {72.5, 0.27}, .kind = Curve::Kind::reference});
  finding.note += " SOFA’s needle plugin gives 0.27 mm at 1e-5 and 72.5 mm at 1e-9 in a case of its own.";
  return finding;
}

Finding drag_over_step(Context&) {
  return drag_over("time step [ms]", {0.25, 0.5, 1.0, 2.0, 4.0}, [](double ms) { return drag(1e-9, 1e-3 * ms); });
}

}  // namespace

std::vector<RowSpec> step_and_tolerance_rows() {
  return {
      {"drag_tolerance", Group::other_code, "The drag on the tissue does not depend on the solver’s tolerance",
       "SOFA’s needle plugin, same friction coefficient at two tolerances", "%", Accepted::at_most(1.0), true,
       drag_over_tolerance},
      {"drag_time_step", Group::independence, "The drag on the tissue does not depend on the time step",
       "time steps of 0.25 … 4 ms", "%", Accepted::at_most(1.0), true, drag_over_step},
      {"time_step", Group::independence, "An insertion with stick and slip does not depend on the time step",
       "time steps of 0.25 … 2 ms", "%", Accepted::at_most(1.0), false, force_over_time_steps},
  };
}

}  // namespace stylet::validate

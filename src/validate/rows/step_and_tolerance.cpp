// SPDX-License-Identifier: GPL-3.0-or-later
// Results must not hang on the time step or on the solver's tolerance.
#include "../rows.hpp"
#include "../scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

Result<Finding> time_steps(Context&) {
  const auto model = Block().compile();
  if (!model) return model.error();
  constexpr double coarsest = 2e-3;
  std::vector<std::vector<double>> forces;  // at multiples of the coarsest step
  Finding finding;
  finding.plot = {.x_label = "time [s]", .y_label = "axial force [N]"};
  double peak = 0.0;
  for (const double dt : {0.25e-3, 0.5e-3, 1e-3, 2e-3}) {
    Drive drive(*model);
    drive.go(55.0, 20.0, dt);
    drive.wait(0.1, dt);
    drive.go(-1.0, 20.0, dt);
    const auto every = static_cast<std::size_t>(std::lround(coarsest / dt));
    std::vector<double>& force = forces.emplace_back();
    Curve curve{.label = fmt::format("{:g} ms", 1e3 * dt), .x = {}, .y = {}};
    for (std::size_t i = every - 1; i < drive.steps().size(); i += every) {
      force.push_back(drive.steps()[i].record.force_axial_N);
      curve.x.push_back(static_cast<double>(force.size()) * coarsest);
      curve.y.push_back(force.back());
    }
    peak = std::max(peak, drive.peak_N());
    finding.plot.curves.push_back(std::move(curve));
  }
  finding.value = 0.0;
  std::string each;
  for (std::size_t k = 1; k < forces.size(); ++k) {
    double sum = 0.0;
    const std::size_t count = std::min(forces[0].size(), forces[k].size());
    for (std::size_t i = 0; i < count; ++i) sum += std::pow(forces[k][i] - forces[0][i], 2);
    const double rms = 100.0 * std::sqrt(sum / static_cast<double>(count)) / peak;
    finding.value = std::max(finding.value, rms);
    each += fmt::format("{}{:.2f} % at {}", each.empty() ? "" : ", ", rms, finding.plot.curves[k].label);
  }
  finding.note = "Skin, capsule, a pause, and out; RMS difference from 0.25 ms over the peak: " + each + ".";
  finding.why_missed = "What differs is the moment of the punctures.";
  return finding;
}

/// How far a needle that goes in by friction takes the tissue with it [mm].
struct Drag {
  double largest_mm = 0.0;
  unsigned flags = 0;
};
Result<Drag> drag(double tolerance, double dt_s) {
  Block block;
  block.gland_radius_mm = 0.0;
  block.scenario.coupling.tolerance = tolerance;
  const auto model = block.compile();
  if (!model) return model.error();
  Drive drive(*model);
  drive.go(40.0, 20.0, dt_s);
  return Drag{drive.insertion().displacement().cwiseAbs().maxCoeff(), drive.flags()};
}

/// @param over what is varied, in words
Result<Finding> drag_over(const std::string& over, const std::vector<double>& values,
                          const std::function<Result<Drag>(double)>& measure) {
  Finding finding;
  Curve curve{.label = "ours", .x = {}, .y = {}};
  for (const double value : values) {
    const auto found = measure(value);
    if (!found) return found.error();
    curve.x.push_back(value);
    curve.y.push_back(found->largest_mm);
  }
  const auto [low, high] = std::minmax_element(curve.y.begin(), curve.y.end());
  finding.value = 100.0 * (*high - *low) / *high;
  finding.note = fmt::format(
      "A needle 40 mm in, the same friction each time; largest displacement of the tissue {:.4f} … {:.4f} mm.", *low,
      *high);
  finding.plot = {.x_label = over, .y_label = "tissue taken along [mm]", .log_x = true, .curves = {curve}};
  return finding;
}

Result<Finding> drag_over_tolerance(Context&) {
  auto finding = drag_over("tolerance of the solver", {1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5},
                           [](double tolerance) { return drag(tolerance, 1e-3); });
  if (finding) {
    finding->plot.log_y = true;
    finding->plot.curves.push_back(
        {.label = "SOFA’s needle plugin", .x = {1e-9, 1e-5}, .y = {72.5, 0.27}, .kind = Curve::Kind::reference});
    finding->note += " SOFA’s needle plugin, on a case of its own: 0.27 mm at 1e-5 and 72.5 mm at 1e-9.";
  }
  return finding;
}

Result<Finding> drag_over_step(Context&) {
  return drag_over("time step [ms]", {0.25, 0.5, 1.0, 2.0, 4.0}, [](double ms) { return drag(1e-9, 1e-3 * ms); });
}

}  // namespace

std::vector<RowSpec> step_and_tolerance_rows() {
  return {
      {"drag_tolerance", Group::other_code, "How far tissue is dragged along does not hang on the solver’s tolerance",
       "SOFA’s needle plugin, same friction coefficient at two tolerances", "%", Accepted::at_most(1.0), true,
       drag_over_tolerance},
      {"drag_time_step", Group::independence, "How far tissue is dragged along does not hang on the time step",
       "each other, 0.25 … 4 ms", "%", Accepted::at_most(1.0), true, drag_over_step},
      {"time_step", Group::independence, "A stick-slip insertion does not hang on the time step",
       "each other, 0.25 … 2 ms", "%", Accepted::at_most(1.0), false, time_steps},
  };
}

}  // namespace stylet::validate

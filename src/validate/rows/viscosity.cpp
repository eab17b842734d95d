// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous tissue against the closed forms of a Kelvin–Voigt solid.
#include "../rows.hpp"
#include "../scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

constexpr double kTau_s = 0.2;
constexpr double kStep_s = 1e-3;
constexpr double kPressSpeed_mm_per_s = 4.0;
constexpr double kDent_mm = 4.0;

Result<std::shared_ptr<const Model>> block(double relaxation_s, double puncture_N) {
  Block block;
  block.gland_radius_mm = 0.0;
  block.scenario.tissue_model.relaxation_s = relaxation_s;
  block.tissue("body").puncture_N = puncture_N;
  return block.compile();
}

Result<Finding> viscosity(Context&) {
  constexpr double never_N = 20.0;
  constexpr double soon_N = 0.2;
  const auto elastic = block(0.0, never_N);
  const auto viscous = block(kTau_s, never_N);
  const auto soft = block(kTau_s, soon_N);
  for (const auto* model : {&elastic, &viscous, &soft})
    if (!*model) return model->error();

  // Pressed in at constant speed and held.
  Drive at_rest(*elastic, 0.0);
  at_rest.go(kDent_mm, kPressSpeed_mm_per_s, kStep_s);
  const double held_N = at_rest.last().record.force_axial_N;
  const double stiffness = held_N / kDent_mm;
  Drive pressing(*viscous, 0.0);
  pressing.go(kDent_mm, kPressSpeed_mm_per_s, kStep_s);
  pressing.wait(kTau_s, kStep_s);
  const double moving_s = kDent_mm / kPressSpeed_mm_per_s;
  double press_off = 0.0;
  Curve force{.label = "force over the held force", .x = {}, .y = {}};
  Curve force_law{.label = "k (d + τ v)", .x = {}, .y = {}, .kind = Curve::Kind::reference};
  for (std::size_t i = 0; i < pressing.steps().size(); ++i) {
    const double time = kStep_s * static_cast<double>(i + 1);
    const bool moves = time < moving_s + 0.5 * kStep_s;
    const double dent = std::min(kDent_mm, kPressSpeed_mm_per_s * time);
    const double law = stiffness * (dent + (moves ? kTau_s * kPressSpeed_mm_per_s : 0.0)) / held_N;
    const double found = pressing.steps()[i].record.force_axial_N / held_N;
    press_off = worse(press_off, 100.0 * std::abs(found - law));
    force.add(time / kTau_s, found);
    force_law.add(time / kTau_s, law);
  }

  // In, out, and left alone.
  Drive drive(*soft);
  drive.go(30.0, 20.0, kStep_s);
  drive.go(-2.0, 40.0, kStep_s);
  const VecX first = drive.insertion().displacement();
  double relax_off = 0.0;
  Curve left{.label = "displacement over the first, needle out", .x = {0.0}, .y = {1.0}};
  Curve law{.label = "exp(−t/τ)", .x = {0.0}, .y = {1.0}, .kind = Curve::Kind::reference};
  for (int look = 1; look <= 30; ++look) {
    constexpr double every_s = 0.1 * kTau_s;
    drive.wait(every_s, kStep_s);
    const double time = every_s * look;
    const double expected = std::exp(-time / kTau_s);
    const VecX now = drive.insertion().displacement();
    relax_off = worse(relax_off, 100.0 * (now - expected * first).norm() / first.norm());
    left.add(time / kTau_s, now.norm() / first.norm());
    law.add(time / kTau_s, expected);
  }

  Finding finding;
  finding.value = worse(press_off, relax_off);
  finding.note = fmt::format(
      "τ = {:g} s, steps of {:g} ms. The tip pressed into the skin at {:g} mm/s and held: the force is off by at most "
      "{:.2f} % of the held {:.3f} N, whose stiffness k is the elastic block’s; most in the step after a start or "
      "stop, which the needle’s own "
      "compression softens. A needle taken out after 30 mm: the "
      "whole field of displacement, {:.2f} mm at first, dies away to within {:.2f} % of that.",
      kTau_s, 1e3 * kStep_s, kPressSpeed_mm_per_s, press_off, held_N, first.cwiseAbs().maxCoeff(), relax_off);
  finding.why_missed = "Steps in time are of first order: dt/(2τ) of the change is to be expected.";
  finding.plot = {.x_label = "time over τ", .y_label = "force, displacement", .curves = {force, left, force_law, law}};
  return finding;
}

}  // namespace

std::vector<RowSpec> viscosity_rows() {
  return {{"viscosity", Group::analysis, "Viscous tissue creeps and relaxes as a Kelvin–Voigt solid does",
           "k (d + τ v); exp(−t/τ)", "%", Accepted::at_most(1.0), true, viscosity}};
}

}  // namespace stylet::validate

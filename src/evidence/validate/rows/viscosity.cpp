// SPDX-License-Identifier: GPL-3.0-or-later
// Compares creeping tissue with closed forms of the standard linear solid.
#include "../rows.hpp"
#include "../scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

constexpr double kCreep = 4.0;
constexpr double kTau_s = 0.2;
constexpr double kStep_s = 1e-3;
constexpr double kPressSpeed_mm_per_s = 4.0;
constexpr double kDent_mm = 4.0;

std::shared_ptr<const Model> block(double creep, double puncture_N) {
  Block block = Block::of_one_tissue(TissuePreset::linear);
  block.scenario.tissue_model.creep = creep;
  block.scenario.tissue_model.creep_s = kTau_s;
  block.tissue("body").puncture_N = puncture_N;
  return need(block.compile());
}

Finding viscosity(Context&) {
  constexpr double never_N = 20.0;
  constexpr double soon_N = 0.2;
  const auto elastic = block(1.0, never_N);
  const auto viscous = block(kCreep, never_N);
  const auto soft = block(kCreep, soon_N);

  // The tip is pressed in at constant speed and then held.
  Drive at_rest(elastic, 0.0);
  at_rest.go(kDent_mm, kPressSpeed_mm_per_s, kStep_s);
  const double held_N = at_rest.last().record.force_axial_N;
  const double stiffness = held_N / kDent_mm;
  Drive pressing(viscous, 0.0);
  pressing.go(kDent_mm, kPressSpeed_mm_per_s, kStep_s);
  pressing.wait(kTau_s, kStep_s);
  const double moving_s = kDent_mm / kPressSpeed_mm_per_s;
  // dent = f/k + F (r − 1) m and m + τ ṁ = f, so τ ṁ = k dent − β m, where f is the force, k the stiffness, F the wide
  // compliance, r the creep and m the memory. `remembered` gives m for a dent that grows at constant speed and then
  // stays.
  const Vec3 axis = pressing.insertion().needle().tangent(0.0);
  const double wide = axis.dot(pressing.insertion().compliance().wide(0, 0) * axis);
  const double beta = 1.0 + stiffness * wide * (kCreep - 1.0);
  const auto remembered = [&](double time) {
    const double rate = beta / kTau_s;
    const double moving = std::min(time, moving_s);
    const double then = stiffness * kPressSpeed_mm_per_s / beta * (moving + std::expm1(-rate * moving) / rate);
    const double at_last = held_N / beta;
    return time < moving_s ? then : at_last + (then - at_last) * std::exp(-rate * (time - moving_s));
  };
  double press_off = 0.0;
  Curve force{.label = "force / force of elastic tissue"};
  Curve force_law{.label = "standard linear solid", .kind = Curve::Kind::reference};
  for (std::size_t i = 0; i < pressing.steps().size(); ++i) {
    const double time = kStep_s * static_cast<double>(i + 1);
    const double dent = std::min(kDent_mm, kPressSpeed_mm_per_s * time);
    const double law = stiffness * (dent - wide * (kCreep - 1.0) * remembered(time)) / held_N;
    const double found = pressing.steps()[i].record.force_axial_N / held_N;
    press_off = worse(press_off, 100.0 * std::abs(found - law));
    force.add(time / kTau_s, found);
    force_law.add(time / kTau_s, law);
  }

  // The needle goes in and out, and the tissue relaxes.
  Drive drive(soft);
  drive.go(30.0, 20.0, kStep_s);
  drive.go(-2.0, 40.0, kStep_s);
  const VecX first = drive.insertion().displacement();
  double relax_off = 0.0;
  Curve left{.label = "displacement / initial displacement, needle out", .x = {0.0}, .y = {1.0}};
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
      "Creep r = {:g}, τ = {:g} s, steps of {:g} ms. The tip is pressed into the skin at {:g} mm/s and held: the error "
      "of the force is at most {:.2f} % of the {:.3f} N with elastic tissue, of which creep finally removes {:.1f} %. "
      "A needle is taken out after 30 mm: the field of displacement, at first {:.2f} mm, decays as predicted to within "
      "{:.2f} % of its initial value.",
      kCreep, kTau_s, 1e3 * kStep_s, kPressSpeed_mm_per_s, press_off, held_N, 100.0 * (1.0 - 1.0 / beta),
      first.cwiseAbs().maxCoeff(), relax_off);
  finding.why_missed = "The time integration is of first order, so an error of dt/(2τ) of the change is expected.";
  finding.plot = {
      .x_label = "time / τ", .y_label = "relative force, displacement", .curves = {force, left, force_law, law}};
  return finding;
}

}  // namespace

std::vector<RowSpec> viscosity_rows() {
  return {{"viscosity", Group::analysis, "Tissue creeps and relaxes like a standard linear solid",
           "k (dent − F p); exp(−t/τ)", "%", Accepted::at_most(1.0), true, viscosity}};
}

}  // namespace stylet::validate

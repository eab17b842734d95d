// SPDX-License-Identifier: GPL-3.0-or-later
// Forces against published measurements: liver ex vivo with its measured parameters, a gel, and the demo patient with
// this program's defaults.
#include "../rows.hpp"
#include "../scene.hpp"
#include "published_values.hpp"
#include "stylet/sim/cutting_lag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

using namespace published;

/// Liver as Okamura et al. measured it, one tissue.
Block liver() {
  Block block;
  block.gland_radius_mm = 0.0;
  TissueParameters& tissue = block.tissue("body");
  tissue.young_kPa = okamura::modulus_kPa(block.scenario.needle.diameter_mm, tissue.poisson);
  tissue.puncture_N = okamura::kPuncture.mean;
  tissue.cutting_N = okamura::kCutting.mean;
  tissue.friction_static_N_per_m = okamura::kStatic_N_per_m;
  tissue.friction_coulomb_N_per_m = okamura::kCoulomb_N_per_m;
  tissue.friction_viscous_Ns_per_m2 = okamura::kViscous_Ns_per_m2;
  return block;
}

Curve force_curve(const Drive& drive) {
  return {.label = "ours",
          .x = column(drive.steps(), &Step::base_depth_mm),
          .y = column(drive.steps(), &Step::force_axial_N)};
}

/// Goes in at 3 mm/s until 8 mm beyond the puncture.
Result<Drive> puncture_liver() {
  const auto model = liver().compile();
  if (!model) return model.error();
  Drive drive(*model);
  double stop = 50.0;
  for (double depth = 0.5; depth <= stop; depth += 0.5) {
    drive.go(depth, okamura::kSpeed_mm_per_s, 5e-3);
    if (const Event* event = drive.event(EventKind::puncture)) stop = std::min(stop, event->depth_mm + 8.0);
  }
  return drive;
}

Result<Finding> liver_puncture_depth(Context&) {
  const auto drive = puncture_liver();
  if (!drive) return drive.error();
  const Event* event = drive->event(EventKind::puncture);
  Finding finding;
  if (event != nullptr) finding.value = event->depth_mm;
  const Block block = liver();
  finding.note = fmt::format(
      "Puncture at {:.2f} N as measured, modulus {:.0f} kPa from the measured stiffness at that depth by the flat "
      "punch "
      "(2 R E / (1 − ν²)): how far the tissue gives way before it breaks is computed.",
      okamura::kPuncture.mean, block.scenario.tissue.at("body").young_kPa);
  finding.why_missed =
      "A contact tied to the mesh is held by a whole element: on a coarse mesh the tip’s own field, a few radii wide, "
      "is "
      "missing, and the tissue seems many times too stiff. With the near-field coupling that is no longer the reason.";
  finding.plot = {.x_label = "base depth [mm]", .y_label = "axial force [N]", .curves = {force_curve(*drive)}};
  Curve measured{.label = "measured stiffness", .x = {}, .y = {}, .kind = Curve::Kind::reference};
  for (int k = 0; k <= 33; ++k) {
    const double z = okamura::kPunctureDepth.mean * k / 33.0;
    measured.x.push_back(z);
    measured.y.push_back(okamura::stiffness_N(z));
  }
  finding.plot.curves.push_back(std::move(measured));
  return finding;
}

Result<Finding> liver_puncture_drop(Context&) {
  const auto drive = puncture_liver();
  if (!drive) return drive.error();
  const Event* event = drive->event(EventKind::puncture);
  Finding finding;
  if (event == nullptr) return finding;
  double lowest = event->force_N;
  for (const DriveStep& s : drive->steps())
    if (s.record.time_s > event->time_s) lowest = std::min(lowest, s.record.force_axial_N);
  finding.value = event->force_N - lowest;
  finding.note =
      fmt::format("From {:.2f} N down to {:.2f} N; cutting force {:.2f} N as measured elsewhere in the study.",
                  event->force_N, lowest, okamura::kCutting.mean);
  finding.why_missed =
      "The force falls to the cutting force. The study’s puncture (2.30 N) and cutting force (0.94 N, from other "
      "insertions) "
      "differ by more than its mean drop.";
  finding.plot = {.x_label = "base depth [mm]", .y_label = "axial force [N]", .curves = {force_curve(*drive)}};
  return finding;
}

Result<Finding> gel_force(Context&) {
  Block block;
  block.gland_radius_mm = 0.0;
  TissueParameters& tissue = block.tissue("body");
  tissue.young_kPa = dimaio::kYoung_kPa;
  tissue.poisson = dimaio::kPoisson;
  tissue.puncture_N = dimaio::kPuncture_N;
  tissue.cutting_N = dimaio::kTipExcess_N;
  tissue.friction_coulomb_N_per_m = tissue.friction_static_N_per_m = dimaio::kFriction_N_per_m;
  tissue.friction_viscous_Ns_per_m2 = 0.0;
  block.depth_mm = dimaio::kDepth_mm;
  const auto model = block.compile();
  if (!model) return model.error();
  Drive drive(*model);
  drive.go(dimaio::kDepth_mm, dimaio::kSpeed_mm_per_s, 20e-3);
  Finding finding;
  finding.value = drive.last().record.force_axial_N;
  finding.note =
      "PVC gel at 1 mm/s: measured friction per length, modulus, Poisson’s ratio and puncture force go in, force at 70 "
      "mm "
      "comes out. The tip’s excess is its measured peak of force density over one tip length.";
  finding.plot = {
      .x_label = "base depth [mm]",
      .y_label = "axial force [N]",
      .curves = {force_curve(drive),
                 {.label = "measured, about", .x = {11, 70}, .y = {0.7, 2.3}, .kind = Curve::Kind::reference}}};
  return finding;
}

// The demo patient with this program's defaults.

Plot demo_plot(const RecordedRun& run) {
  Curve force{.label = "the demo", .x = {}, .y = {}};
  for (const Step& s : run.steps) {
    force.x.push_back(s.time_s);
    force.y.push_back(s.force_axial_N);
  }
  return {.x_label = "time [s]", .y_label = "axial force [N]", .curves = {force}};
}

Result<Finding> demo_puncture_force(Context& context) {
  const auto run = context.demo_run();
  if (!run) return run.error();
  Finding finding;
  if (const Event* event = (*run)->event(EventKind::puncture)) finding.value = event->force_N;
  finding.note =
      fmt::format("The perineal skin of the demo. Median of 24 studies: {:.2f} N; bovine liver: 2.30 ± 0.83 N.",
                  vanGerwen::kPuncture_N);
  const TissueParameters skin = default_tissue("body");
  finding.why_missed = fmt::format(
      "The default is chosen with the modulus so that linear tissue tents by a plausible depth (docs/parameters.md): "
      "{:.1f} "
      "N on linear tissue of {:g} kPa would tent by {:.0f} mm. Real tissue stiffens as it is pressed.",
      okamura::kPuncture.mean, skin.young_kPa,
      tenting_mm(skin, okamura::kPuncture.mean, (*run)->model->scenario().needle.diameter_mm));
  return finding;
}

Result<Finding> demo_puncture_depth(Context& context) {
  const auto run = context.demo_run();
  if (!run) return run.error();
  Finding finding;
  const Event* skin = (*run)->event(EventKind::skin_contact);
  const Event* puncture = (*run)->event(EventKind::puncture);
  if (skin != nullptr && puncture != nullptr) finding.value = puncture->depth_mm - skin->depth_mm;
  finding.note = "How far the base goes from touching the perineal skin to its puncture.";
  const TissueParameters tissue = default_tissue("body");
  finding.why_missed = fmt::format(
      "A flat punch at the same force and modulus sinks in by {:.0f} mm. A contact tied to the mesh is held by whole "
      "elements "
      "and far too stiff; with the near-field coupling that is no longer the reason.",
      tenting_mm(tissue, tissue.puncture_N, (*run)->model->scenario().needle.diameter_mm));
  return finding;
}

Result<Finding> demo_cutting_force(Context& context) {
  const auto run = context.demo_run();
  if (!run) return run.error();
  Finding finding;
  const auto& regions = (*run)->model->mesh().regions;
  const auto gland = std::find(regions.begin(), regions.end(), "prostate");
  if (gland == regions.end()) return failure("the demo", "there is no prostate in its mesh", "Check the demo patient");
  for (const Frame& frame : (*run)->events) {
    if (frame.label != "deepest") continue;
    for (const ContactView& contact : frame.contacts)
      if (contact.tip) finding.value = contact.force.norm();
  }
  finding.note = fmt::format("Force on the tip at the deepest point, in the gland. Median of 10 studies: {:.2f} N.",
                             vanGerwen::kCutting_N);
  const TissueParameters tissue = default_tissue("prostate");
  finding.why_missed = fmt::format(
      "The default is low on purpose: in linear tissue of {:g} kPa a cutting force of {:.2f} N would let the tip lag "
      "{:.0f} "
      "mm behind the base (docs/parameters.md).",
      tissue.young_kPa, okamura::kCutting.mean,
      cutting_lag_mm(tissue, okamura::kCutting.mean, (*run)->model->scenario().needle.diameter_mm));
  return finding;
}

Result<Finding> demo_friction(Context& context) {
  const auto run = context.demo_run();
  if (!run) return run.error();
  // Slope of the force against depth, on the way through the perineum.
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  const Event* puncture = (*run)->event(EventKind::puncture);
  const double from = (puncture != nullptr ? puncture->depth_mm : 0.0) + 5.0;
  for (const Step& s : (*run)->steps) {
    if (s.tip_state != TipState::cutting || s.base_depth_mm < from || s.base_depth_mm > from + 18.0) continue;
    n += 1;
    sx += s.base_depth_mm;
    sy += s.force_axial_N;
    sxx += s.base_depth_mm * s.base_depth_mm;
    sxy += s.base_depth_mm * s.force_axial_N;
  }
  Finding finding;
  if (n > 10) finding.value = 1e3 * (n * sxy - sx * sy) / (n * sxx - sx * sx);
  finding.note =
      "Slope of the base force over 18 mm of perineum at 20 mm/s. Liver: 11 N/m and 0.21 … 0.29 N/m for each mm/s; PVC "
      "gel: 34 "
      "… 80 N/m.";
  return finding;
}

Result<Finding> demo_peak_force(Context& context) {
  const auto run = context.demo_run();
  if (!run) return run.error();
  Finding finding;
  finding.value = (*run)->summary.peak_axial_N;
  finding.note = fmt::format(
      "Medians over all tissues and needles: largest axial force {:g} N (63 papers), puncture {:g} N, cutting {:g} N, "
      "friction {:g} N; a gate of one order of magnitude.",
      vanGerwen::kPeak_N, vanGerwen::kPuncture_N, vanGerwen::kCutting_N, vanGerwen::kFriction_N);
  finding.plot = demo_plot(**run);
  return finding;
}

}  // namespace

std::vector<RowSpec> published_force_rows() {
  const auto one_deviation = [](const Measured& m) {
    return Accepted::between(m.mean - m.deviation, m.mean + m.deviation);
  };
  const char* liver_study = "bovine liver ex vivo, 18G, Okamura, Simone & O’Leary 2004; mean ± one standard deviation";
  return {
      {"liver_puncture_depth", Group::measurements, "Liver tents as deep as measured before its capsule breaks",
       liver_study, "mm", one_deviation(okamura::kPunctureDepth), true, liver_puncture_depth},
      {"liver_puncture_drop", Group::measurements, "The force drops as measured when the capsule breaks", liver_study,
       "N", one_deviation(okamura::kDrop), true, liver_puncture_drop},
      {"gel_force", Group::measurements, "Force at 70 mm in PVC gel follows from its friction per length",
       "DiMaio & Salcudean 2003, read from a figure: 2.3 N, ± 15 %", "N", Accepted::between(1.955, 2.645), true,
       gel_force},
      {"demo_puncture_force", Group::measurements, "Demo patient: puncture force as in liver", liver_study, "N",
       one_deviation(okamura::kPuncture), false, demo_puncture_force},
      {"demo_puncture_depth", Group::measurements, "Demo patient: depth at puncture as in liver", liver_study, "mm",
       one_deviation(okamura::kPunctureDepth), false, demo_puncture_depth},
      {"demo_cutting_force", Group::measurements, "Demo patient: cutting force as in liver", liver_study, "N",
       one_deviation(okamura::kCutting), false, demo_cutting_force},
      {"demo_friction", Group::measurements, "Demo patient: friction per length within what is published",
       "11 N/m (liver, Okamura 2004) … 80 N/m (PVC at 9 mm/s, DiMaio 2003)", "N/m", Accepted::between(11.0, 80.0),
       false, demo_friction},
      {"demo_peak_force", Group::measurements, "Demo patient: largest force of the right order",
       "van Gerwen, Dankelman & van den Dobbelsteen 2012, 99 papers", "N", Accepted::between(0.1, 10.0), false,
       demo_peak_force},
  };
}

}  // namespace stylet::validate

// SPDX-License-Identifier: GPL-3.0-or-later
// Compares forces with published measurements: liver ex vivo with its measured parameters, a gel, and the demo patient
// with the default values.
#include "../rows.hpp"
#include "../scene.hpp"
#include "published_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

using namespace published;

/// A block of one tissue with the values that Okamura et al. measured in liver.
Block liver() {
  Block block = Block::of_one_tissue(TissuePreset::linear);
  TissueParameters& tissue = block.tissue("body");
  tissue.young_kPa = okamura::modulus_kPa(block.scenario.needle.diameter_mm, tissue.poisson);
  tissue.puncture_N = okamura::kPuncture.mean;
  tissue.cutting_N = okamura::kCutting.mean;
  tissue.friction_static_N_per_m = okamura::kStatic_N_per_m;
  tissue.friction_coulomb_N_per_m = okamura::kCoulomb_N_per_m;
  tissue.friction_viscous_Ns_per_m2 = okamura::kViscous_Ns_per_m2;
  return block;
}

/// Inserts a needle at 3 mm/s until 8 mm beyond the puncture.
Drive puncture_liver() {
  Drive drive(need(liver().compile()));
  double stop = 50.0;
  for (double depth = 0.5; depth <= stop; depth += 0.5) {
    drive.go(depth, okamura::kSpeed_mm_per_s, 5e-3);
    if (const Event* event = drive.event(EventKind::puncture)) stop = std::min(stop, event->depth_mm + 8.0);
  }
  return drive;
}

Finding liver_puncture_drop(Context&) {
  const auto drive = puncture_liver();
  const Event* event = drive.event(EventKind::puncture);
  Finding finding;
  if (event == nullptr) return finding;
  double lowest = event->force_N;
  for (const DriveStep& s : drive.steps())
    if (s.record.time_s > event->time_s) lowest = std::min(lowest, s.record.force_axial_N);
  finding.value = event->force_N - lowest;
  finding.note = fmt::format(
      "The force falls from {:.2f} N to {:.2f} N; the cutting force is {:.2f} N, from other insertions of the study.",
      event->force_N, lowest, okamura::kCutting.mean);
  finding.why_missed =
      "The force falls to the cutting force. The study’s puncture force (2.30 N) and cutting force (0.94 N, from other "
      "insertions) differ by more than its mean drop.";
  finding.plot = {.x_label = "base depth [mm]", .y_label = "axial force [N]", .curves = {curve_of(drive, "ours")}};
  return finding;
}

Finding gel_force(Context&) {
  Block block = Block::of_one_tissue(TissuePreset::linear);
  TissueParameters& tissue = block.tissue("body");
  tissue.young_kPa = dimaio::kYoung_kPa;
  tissue.poisson = dimaio::kPoisson;
  tissue.puncture_N = dimaio::kPuncture_N;
  tissue.cutting_N = dimaio::kTipExcess_N;
  tissue.friction_coulomb_N_per_m = tissue.friction_static_N_per_m = dimaio::kFriction_N_per_m;
  tissue.friction_viscous_Ns_per_m2 = 0.0;
  block.depth_mm = dimaio::kDepth_mm;
  Drive drive(need(block.compile()));
  drive.go(dimaio::kDepth_mm, dimaio::kSpeed_mm_per_s, 20e-3);
  Finding finding;
  finding.value = drive.last().record.force_axial_N;
  finding.note =
      "PVC gel at 1 mm/s. The simulation uses the measured friction per length, modulus, Poisson’s ratio and puncture "
      "force; the value is the force at 70 mm. The cutting force is the measured peak of force density at the tip over "
      "one tip length.";
  finding.plot = {
      .x_label = "base depth [mm]",
      .y_label = "axial force [N]",
      .curves = {curve_of(drive, "ours"),
                 {.label = "measured, approximate", .x = {11, 70}, .y = {0.7, 2.3}, .kind = Curve::Kind::reference}}};
  return finding;
}

/// The force on the tip in the demo patient with default values.
Finding demo_cutting_force(Context& context) {
  const auto run = need(context.demo_run());
  Finding finding;
  const auto& regions = run->model->mesh().regions;
  const auto gland = std::find(regions.begin(), regions.end(), "prostate");
  if (gland == regions.end()) throw Failed{failure("the demo", "its mesh has no prostate", "Check the demo patient")};
  for (const Frame& frame : run->events) {
    if (frame.label != "deepest") continue;
    for (const ContactView& contact : frame.contacts)
      if (contact.tip) finding.value = contact.force.norm();
  }
  finding.note = fmt::format(
      "The value is the force on the tip at the deepest point, in the gland. The median of 10 studies is {:.2f} N.",
      vanGerwen::kCutting_N);
  finding.why_missed = "The default cutting force, 1.5 N, is fitted to the force in patients’ glands, not to liver.";
  return finding;
}

}  // namespace

std::vector<RowSpec> published_force_rows() {
  const auto one_deviation = [](const Measured& m) {
    return Accepted::between(m.mean - m.deviation, m.mean + m.deviation);
  };
  const char* liver_study = "bovine liver ex vivo, 18G, Okamura, Simone & O’Leary 2004; mean ± one standard deviation";
  return {
      {"liver_puncture_drop", Group::measurements, "When the capsule breaks, the force drops as measured", liver_study,
       "N", one_deviation(okamura::kDrop), true, liver_puncture_drop},
      {"gel_force", Group::measurements, "The force at 70 mm in PVC gel follows from its friction per length",
       "DiMaio & Salcudean 2003, read from a figure: 2.3 N, ± 15 %", "N", Accepted::between(1.955, 2.645), true,
       gel_force},
      {"demo_cutting_force", Group::measurements, "Demo patient: the cutting force is as in liver", liver_study, "N",
       one_deviation(okamura::kCutting), false, demo_cutting_force},
  };
}

}  // namespace stylet::validate

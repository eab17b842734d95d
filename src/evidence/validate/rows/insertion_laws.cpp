// SPDX-License-Identifier: GPL-3.0-or-later
// Compares whole insertions with closed forms of the laws of cutting and friction.
#include "../rows.hpp"
#include "../scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::validate {

namespace {

double percent_off(double value, double expected) { return 100.0 * std::abs(value / expected - 1.0); }

Finding steady_cutting(Context&) {
  const auto model = need(Block::of_one_tissue().compile());
  const RegionLaws& laws = model->laws().front();
  constexpr double speed = 10.0;
  const double along = laws.friction.coulomb_N_per_mm + laws.friction.viscous_Ns_per_mm2 * speed;
  const double tip = laws.cutting_N + model->coupling().tip_viscosity_Ns_per_mm * speed;
  Finding finding{.value = 0.0};
  Curve law{.label = "cutting + friction", .kind = Curve::Kind::reference};
  Drive drive(model);
  for (double depth = 2.0; depth <= 50.0; depth += 2.0) {
    drive.go(depth, speed);
    if (drive.simulation().last_step().tip_state != TipState::cutting || depth < 20.0) continue;
    const double expected = tip + along * drive.simulation().last_step().inserted_mm;
    finding.value = worse(finding.value, percent_off(drive.last().record.force_axial_N, expected));
    law.add(depth, expected);
  }
  finding.note = "One tissue, constant speed, from 20 mm depth on. The formula uses the simulated inserted length.";
  finding.why_missed = "The force is not quite constant where contacts are laid.";
  finding.plot = {.x_label = "base depth [mm]", .y_label = "axial force [N]", .curves = {curve_of(drive, "ours"), law}};
  return finding;
}

Finding reversal(Context&) {
  const auto model = need(Block::of_one_tissue().compile());
  const FrictionLaw& friction = model->laws().front().friction;
  constexpr double speed = 20.0;
  Drive drive(model);
  drive.go(50.0, speed);
  const double pushing = drive.last().record.force_axial_N;
  drive.go(49.9, speed);
  const int sticking = drive.last().record.sticking;
  const int contacts = drive.last().record.contacts;
  drive.go(40.0, speed);
  const double expected =
      -(friction.coulomb_N_per_mm + friction.viscous_Ns_per_mm2 * speed) * drive.simulation().last_step().inserted_mm;
  Finding finding;
  finding.value = percent_off(drive.last().record.force_axial_N, expected);
  finding.note = fmt::format(
      "The needle is pushed in with {:.2f} N. After 0.1 mm of retraction {} of {} contacts stick. After 10 mm all "
      "slip; the hand pulls with {:.3f} N, and the formula gives {:.3f} N.",
      pushing, sticking, contacts, -drive.last().record.force_axial_N, -expected);
  finding.plot = {
      .x_label = "time [s]", .y_label = "axial force [N]", .curves = {curve_of(drive, "ours", &Step::time_s)}};
  return finding;
}

Finding second_pass(Context&) {
  const auto model = need(Block::of_one_tissue().compile());
  const FrictionLaw& friction = model->laws().front().friction;
  constexpr double speed = 10.0;
  Drive drive(model);
  drive.go(40.0, speed);
  drive.go(20.0, speed);
  const double deepest = drive.insertion().track().end_xi;
  drive.go(34.0, speed);
  const double expected =
      (friction.coulomb_N_per_mm + friction.viscous_Ns_per_mm2 * speed) * drive.simulation().last_step().inserted_mm;
  Finding finding;
  finding.value = percent_off(drive.last().record.force_axial_N, expected);
  const double cut = drive.insertion().track().end_xi - deepest;
  if (cut > 0.0) finding.value = 100.0;
  finding.note = fmt::format(
      "The needle goes in to 40 mm, out to 20 mm and in to 34 mm. The force is {:.3f} N, friction alone {:.3f} N; "
      "{:g} mm of new track are cut.",
      drive.last().record.force_axial_N, expected, cut);
  drive.go(45.0, speed);
  finding.plot = {
      .x_label = "time [s]", .y_label = "axial force [N]", .curves = {curve_of(drive, "ours", &Step::time_s)}};
  return finding;
}

Finding withdrawal(Context&) {
  Block block;
  block.scenario.tissue_model.creep = 1.0;  // no creep, whose displacement would last for seconds
  const auto model = need(block.compile({{-9, 7, 0}}));
  Drive used(model);
  used.go(50.0);
  used.go(-1.0);
  const double left = used.insertion().displacement().cwiseAbs().maxCoeff();
  used.aim(1);
  const std::size_t from = used.steps().size();
  used.go(50.0);
  Drive fresh(model, -1.0, 1);
  fresh.go(50.0);
  Finding finding;
  finding.value = left;
  for (std::size_t i = 0; i < fresh.steps().size(); ++i) {
    const double difference = (used.steps()[from + i].hand_force - fresh.steps()[i].hand_force).norm();
    finding.value = worse(finding.value, difference / fresh.peak_N());
  }
  finding.note = fmt::format(
      "After the needle is out, the largest displacement of the tissue is {:g} mm. A second needle at another place "
      "has the same forces as in fresh tissue; the value is the largest difference relative to the peak force.",
      left);
  finding.plot = {
      .x_label = "base depth [mm]", .y_label = "axial force [N]", .curves = {curve_of(fresh, "fresh tissue")}};
  Curve second{.label = "second needle", .kind = Curve::Kind::reference};
  for (std::size_t i = from; i < used.steps().size(); ++i) {
    second.add(used.steps()[i].record.base_depth_mm, used.steps()[i].record.force_axial_N);
  }
  finding.plot.curves.push_back(std::move(second));
  return finding;
}

Finding moved_scene(Context&) {
  const auto run = [](const Eigen::Affine3d& placing) {
    Block block;
    block.direction = {0.1, 0.05, 1.0};
    block.placing = placing;
    const auto model = need(block.compile());
    Drive drive(model);
    drive.go(40.0);
    drive.shift(placing.linear() * Vec3(0.5, 0.2, 0.0));
    drive.go(50.0);
    drive.go(20.0);
    return drive.steps();
  };
  const auto plain = run(Eigen::Affine3d::Identity());
  double peak = 0.0;
  for (const DriveStep& s : plain) peak = std::max(peak, s.hand_force.norm());

  Eigen::Affine3d turned = Eigen::Affine3d::Identity();
  turned.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).pretranslate(Vec3(30, -20, 55));
  Eigen::Affine3d mirrored = Eigen::Affine3d::Identity();
  mirrored.linear().diagonal() << -1.0, 1.0, 1.0;
  Finding finding{.value = 0.0};
  finding.plot = {.x_label = "step", .y_label = "difference / peak force", .log_y = true};
  for (const auto& [label, placing] : {std::pair{"rotated and moved", turned}, {"mirrored", mirrored}}) {
    const auto other = run(placing);
    Curve curve{.label = label};
    for (std::size_t i = 0; i < plain.size(); ++i) {
      const double off = (other[i].hand_force - placing.linear() * plain[i].hand_force).norm() / peak;
      finding.value = worse(finding.value, off);
      curve.add(static_cast<double>(i), off);
    }
    finding.plot.curves.push_back(std::move(curve));
  }
  finding.note = "An oblique insertion through a capsule, with a sideways shift of the base on the way, and back out.";
  return finding;
}

Finding contact_changes(Context&) {
  Block block = Block::of_one_tissue();
  block.scenario.tissue_model.creep = 1.0;  // no creep, because relaxing forces would look like jumps
  block.direction = {0.1, 0.05, 1.0};
  Drive drive(need(block.compile()));
  drive.go(30.0);
  drive.shift({0.6, 0.3, 0.0});
  drive.wait(0.01);
  drive.go(60.0);
  drive.wait(0.02);
  drive.go(5.0);
  const auto& steps = drive.steps();
  const auto force = [&](std::size_t i) { return steps[i].record.force_axial_N; };
  const auto depth = [&](std::size_t i) { return steps[i].record.base_depth_mm; };
  double worst = 0.0;
  int changes = 0;
  Curve jumps{.label = "changes", .kind = Curve::Kind::points};
  for (std::size_t i = 3; i + 2 < steps.size(); ++i) {
    if (steps[i].shaft_contacts == steps[i - 1].shaft_contacts || depth(i) < 8.0) continue;
    if (std::abs(depth(i) - depth(i - 1)) < 1e-9) continue;
    const double around = 0.5 * (force(i - 1) - force(i - 2) + force(i + 1) - force(i));
    const double jump = std::abs(force(i) - force(i - 1) - around);
    worst = std::max(worst, jump);
    ++changes;
    jumps.add(steps[i].record.time_s, 100.0 * jump / drive.peak_N());
  }
  Finding finding;
  finding.value = 100.0 * worst / drive.peak_N();
  if (changes < 10) finding.value = std::numeric_limits<double>::quiet_NaN();  // too few changes to judge
  finding.note = fmt::format(
      "{} contacts are laid or removed on an oblique way in and out. The value is the change of the force at each, "
      "minus the mean of the changes before and after it, relative to the peak force of {:.2f} N.",
      changes, drive.peak_N());
  finding.plot = {.x_label = "time [s]", .y_label = "jump of the force [% of peak]", .curves = {jumps}};
  return finding;
}

Finding energy(Context&) {
  Block block;
  block.direction = {0.05, 0.1, 1.0};
  Drive drive(need(block.compile()), 0.0);
  Finding finding{.value = 0.0};
  Curve work{.label = "work of the hand", .kind = Curve::Kind::reference};
  Curve stored{.label = "stored energy"};
  double from = 0.0;
  // The first millimetre is checked finely: until the skin breaks nearly no energy is lost, and both must agree.
  for (const auto& [to, looks] : {std::pair{1.0, 20}, {20.0, 20}, {50.0, 20}, {30.0, 20}, {60.0, 20}, {20.0, 20}}) {
    for (int k = 1; k <= looks; ++k) {
      drive.go(from + (to - from) * k / looks);
      const double now = drive.insertion().tissue_energy() + drive.insertion().needle().energy();
      if (drive.last().work_Nmm <= 0.0) continue;
      finding.value = worse(finding.value, now / drive.last().work_Nmm);
      work.add(drive.last().record.time_s, drive.last().work_Nmm);
      stored.add(drive.last().record.time_s, now);
    }
    from = to;
  }
  finding.note = fmt::format(
      "The needle goes in and out several times. The value is the largest ratio of stored energy to work of the hand. "
      "Before the skin breaks nearly all work is stored, at the end {:.2f} of {:.0f} N mm.",
      stored.y.back(), work.y.back());
  finding.plot = {.x_label = "time [s]", .y_label = "energy [N mm]", .log_y = true, .curves = {stored, work}};
  return finding;
}

Finding balance(Context& context, bool torque) {
  const auto run = need(context.demo_run());
  Finding finding;
  finding.value = torque ? run->summary.residual_torque_balance : run->summary.residual_force_balance;
  finding.note = fmt::format(
      "The demo insertion, {} steps. The value is the largest sum of the {} that supports and contacts exert on the "
      "tissue, relative to the peak force{}. It says nothing about the hand: its force and torque are computed as the "
      "sum over the contacts, so that hand and contacts balance by definition. The row closed_loops checks the work of "
      "the hand.",
      run->summary.steps, torque ? "moments about the entry point" : "forces", torque ? " × 100 mm" : "");
  if (!torque) {
    Curve force{.label = "the demo"};
    for (const Step& s : run->steps) {
      force.add(s.time_s, s.force_axial_N);
    }
    finding.plot = {.x_label = "time [s]", .y_label = "axial force [N]", .curves = {force}};
  }
  return finding;
}

}  // namespace

std::vector<RowSpec> insertion_law_rows() {
  return {
      {"steady_cutting", Group::analysis, "The hand pushes with cutting force plus friction per inserted length",
       "F_cut + η v + (C + b v) L", "%", Accepted::at_most(2.0), true, steady_cutting},
      {"reversal", Group::analysis, "After a reversal the shaft sticks, then slides, and friction points the other way",
       "−(C + b v) L", "%", Accepted::at_most(2.0), true, reversal},
      {"second_pass", Group::analysis, "Nothing is cut on an existing track until its end", "(C + b v) L; no new track",
       "%", Accepted::at_most(3.0), true, second_pass},
      {"withdrawal", Group::analysis, "After the needle is out, the tissue is as before the insertion",
       "zero; fresh tissue", "", Accepted::at_most(1e-12), true, withdrawal},
      {"moved_scene", Group::analysis, "A rotated, moved or mirrored scene gives the same forces in its own frame",
       "the original scene", "", Accepted::at_most(1e-8), true, moved_scene},
      {"contact_changes", Group::analysis, "Laying and removing contacts causes no jump of the hand’s force",
       "continuity", "%", Accepted::at_most(0.1), true, contact_changes},
      {"energy", Group::analysis, "The hand does at least as much work as energy is stored", "dissipation ≥ 0", "",
       Accepted::at_most(1.0), true, energy},
      {"force_balance", Group::analysis, "Action equals reaction on the tissue: supports and contacts balance",
       "Newton’s third law", "", Accepted::at_most(1e-9), false, [](Context& c) { return balance(c, false); }},
      {"torque_balance", Group::analysis,
       "Action equals reaction on the tissue: moments of supports and contacts balance", "Newton’s third law", "",
       Accepted::at_most(1e-9), false, [](Context& c) { return balance(c, true); }},
  };
}

}  // namespace stylet::validate

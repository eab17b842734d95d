// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the needle models with beam theory.
#include "../rows.hpp"
#include "stylet/needle/make_needle.hpp"
#include "stylet/needle/theory.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace stylet::validate {

namespace {

constexpr double kForce = 1e-5;  ///< [N] small enough for linear geometry to within 1e-6
constexpr double kBalance_Nmm = 1e-8;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Compares the shape under a lateral load with the Euler–Bernoulli beam along the whole needle.
Finding small_deflection(const std::string& model) {
  const NeedleSection section;
  auto needle = need(make_needle(model, section, 0, 8));
  const double length = section.length_mm;
  Finding finding{.value = 0.0};
  for (const double a : {0.2 * length, 0.5 * length, length}) {
    needle->straighten();
    const std::vector<PointLoad> loads{{a, {0, kForce, 0}}};
    need(find_equilibrium(*needle, loads, 1e-10));
    const double tip = cantilever_deflection(kForce, a, length, section.bending_stiffness_Nmm2);
    Curve ours{.label = fmt::format("load at {:g} mm", a)};
    Curve theory{.label = "theory", .kind = Curve::Kind::reference};
    for (int k = 0; k <= 40; ++k) {
      const double s = length * k / 40;
      const double exact = cantilever_deflection(kForce, a, s, section.bending_stiffness_Nmm2);
      const double found = needle->point(s).y();
      finding.value = worse(finding.value, 100.0 * std::abs(found - exact) / tip);
      ours.add(s, 1e3 * found);
      theory.add(s, 1e3 * exact);
    }
    finding.plot.curves.push_back(std::move(ours));
    if (a == length) finding.plot.curves.push_back(std::move(theory));
  }
  finding.plot.x_label = "arc length [mm]";
  finding.plot.y_label = "deflection [µm]";
  finding.note =
      "A 200 mm needle with a lateral load at three places. The value is the largest error of the shape, relative to "
      "the tip’s deflection.";
  return finding;
}

/// Compares the tip's displacement under a dead load with the elastica, up to a slope of 60 degrees.
Finding large_deflection(const std::string& model) {
  const NeedleSection section;
  auto needle = need(make_needle(model, section, 0, 8));
  Finding finding{.value = 0.0};
  Curve ours{.label = model};
  Curve theory{.label = "elastica", .kind = Curve::Kind::reference};
  for (int degrees = 5; degrees <= 60; degrees += 5) {
    const Elastica exact(degrees * kDegree, section.length_mm, section.bending_stiffness_Nmm2);
    const std::vector<PointLoad> loads{{section.length_mm, {exact.force, 0, 0}}};
    need(find_equilibrium(*needle, loads, kBalance_Nmm * 10.0));
    const Vec3 tip = needle->point(section.length_mm);
    const double shortening = section.length_mm - exact.reach;
    finding.value = std::max({finding.value, 100.0 * std::abs(tip.x() / exact.deflection - 1.0),
                              100.0 * std::abs((section.length_mm - tip.z()) / shortening - 1.0)});
    ours.add(exact.force, tip.x());
    theory.add(exact.force, exact.deflection);
  }
  finding.plot = {.x_label = "force [N]", .y_label = "tip deflection [mm]", .curves = {ours, theory}};
  finding.note =
      "A dead load across the tip with slopes of the tip from 5° to 60°. The value is the largest error of deflection "
      "and shortening.";
  return finding;
}

}  // namespace

std::vector<RowSpec> needle_theory_rows() {
  std::vector<RowSpec> rows;
  for (const std::string& model : needle_models()) {
    rows.push_back({"needle_small_" + model, Group::analysis,
                    fmt::format("Needle model “{}” bends like a thin beam under small loads", model),
                    "Euler–Bernoulli cantilever", "%", Accepted::at_most(0.5), true,
                    [model](Context&) { return small_deflection(model); }});
  }
  for (const std::string& model : needle_models()) {
    rows.push_back({"needle_large_" + model, Group::analysis,
                    fmt::format("Needle model “{}” follows the elastica to 60° of tip rotation", model),
                    "elastica, Bisshopp & Drucker 1945", "%", Accepted::at_most(1.0), true,
                    [model](Context&) { return large_deflection(model); }});
  }
  return rows;
}

}  // namespace stylet::validate

// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a whole insertion must not depend on the mesh.
#include "../rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

constexpr const char* kDefault = "near-field";
/// Coarser meshes are shown but not judged.
constexpr Index kCoarsest = 1500;

/// The force of the hand, with a point every 20 ms.
Curve curve_of(const DemoOnMesh& row) {
  Curve curve{.label = fmt::format("{}, {} nodes", row.method, row.nodes)};
  if (row.method != kDefault) curve.kind = Curve::Kind::reference;
  const auto every = static_cast<std::size_t>(std::max(1L, std::lround(20e-3 / row.curve.dt_s)));
  for (std::size_t k = every; k <= row.curve.force_N.size(); k += every)
    curve.add(static_cast<double>(k) * row.curve.dt_s, row.curve.force_N[k - 1]);
  return curve;
}

Finding force(Context& context) {
  const auto rows = need(context.demo_on_meshes());
  Finding finding;
  finding.plot = {.x_label = "time [s]", .y_label = "axial force [N]"};
  finding.value = 0.0;
  std::string others;
  for (const DemoOnMesh& row : rows) {
    if (row.method == kDefault) {
      if (row.nodes >= kCoarsest) finding.value = worse(finding.value, row.rms_vs_finest_percent);
      finding.note += fmt::format("{} nodes: RMS difference {:.2f} %, skin breaks at {:.1f} mm, capsule at {:.1f} mm. ",
                                  row.nodes, row.rms_vs_finest_percent, row.skin_mm, row.capsule_mm);
      finding.plot.curves.push_back(curve_of(row));
    } else {
      others += fmt::format("{}{}: {:.2f} %, {:.1f} mm", others.empty() ? "" : "; ", row.nodes,
                            row.rms_vs_finest_percent, row.skin_mm);
      if (finding.plot.curves.back().kind == Curve::Kind::ours) finding.plot.curves.push_back(curve_of(row));
    }
  }
  finding.note += fmt::format(
      "With node addition (finest mesh dashed), nodes, RMS difference from its own finest mesh and depth at which the "
      "skin breaks: {}. The mesh of 500 nodes is shown but not judged, because its layers are thinner than an element "
      "(docs/theory/near_field_evidence.md).",
      others);
  finding.why_missed =
      "The capsule breaks at the same force but at another depth: at the border of fat and gland the tip’s own "
      "compliance still depends on the mesh (docs/theory/near_field_evidence.md).";
  return finding;
}

Finding shift(Context& context) {
  const auto rows = need(context.demo_on_meshes());
  Finding finding;
  finding.plot = {.x_label = "nodes", .y_label = "shift of the gland [mm]", .log_x = true};
  finding.value = 0.0;
  double finest = 0.0;
  for (const DemoOnMesh& row : rows) {
    auto& curves = finding.plot.curves;
    if (curves.empty() || curves.back().label != row.method) {
      finest = row.target_shift_mm;
      curves.push_back({.label = row.method});
      if (row.method != kDefault) curves.back().kind = Curve::Kind::reference;
    }
    curves.back().add(row.nodes, row.target_shift_mm);
    const double off = 100.0 * (row.target_shift_mm / finest - 1.0);
    if (row.method == kDefault && row.nodes >= kCoarsest) finding.value = worse(finding.value, std::abs(off));
    finding.note += fmt::format("{}{} nodes: {:.4f} mm ({:+.1f} %). ", row.method == kDefault ? "" : "Node addition, ",
                                row.nodes, row.target_shift_mm, off);
  }
  for (Curve& curve : finding.plot.curves) {
    std::reverse(curve.x.begin(), curve.x.end());
    std::reverse(curve.y.begin(), curve.y.end());
  }
  finding.note +=
      "The target’s mean displacement is computed from the needle’s forces by reciprocity, on coarse meshes with "
      "quadratic elements.";
  finding.why_missed =
      "The field of a body force on the target, from which its shift is computed, still depends on the mesh, mainly "
      "near the ends of supports.";
  return finding;
}

}  // namespace

std::vector<RowSpec> insertion_over_meshes_rows() {
  return {
      {"insertion_mesh_force", Group::independence, "The force of a whole insertion does not depend on the mesh",
       "meshes of 2,000 and 10,000 nodes; RMS difference / peak", "%", Accepted::at_most(3.0), false, force},
      {"insertion_mesh_shift", Group::independence, "The shift of the gland does not depend on the mesh",
       "meshes of 2,000 and 10,000 nodes", "%", Accepted::at_most(7.0), false, shift},
  };
}

}  // namespace stylet::validate

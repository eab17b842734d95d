// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "record/run_columns.hpp"

/// The keys of summary.json of an insertion; docs/results says what they mean.
namespace stylet {

void columns(auto& visit, record::Of<MeshChange> auto& m) {
  using record::Field;
  visit(Field("time_s", "s"), m.time_s);
  visit(Field("depth_mm", "mm"), m.depth_mm);
  visit(Field("kind"), m.change.kind);
  visit(Field("not_moved_because"), m.change.refused);
  visit(Field("node"), m.change.node);
  visit(Field("dimension"), m.change.dimension);
  visit(Field("elements"), m.change.elements);
  visit(Field("moved_mm", "mm"), m.change.moved_mm);
  visit(Field("condition"), m.change.condition);
}

void columns(auto& visit, record::Of<CapacityUse> auto& c) {
  visit(record::Field("most"), c.most);
  visit(record::Field("room"), c.room);
}

void columns(auto& visit, record::Of<CapacityUses> auto& c) {
  using record::Field;
  visit(Field("contacts"), c.contacts);
  visit(Field("spare_nodes"), c.spare_nodes);
  visit(Field("tracks"), c.tracks);
  visit(Field("events"), c.events);
}

void columns(auto& visit, record::Of<Summary::Blur> auto& b) {
  using record::Field;
  visit(Field("min", "mm"), b.smallest_mm);
  visit(Field("median", "mm"), b.median_mm);
  visit(Field("max", "mm"), b.largest_mm);
  visit(Field("nodes"), b.nodes);
}

void columns(auto& visit, record::Of<NeedlesInPlace> auto& n) {
  using record::Field;
  visit(Field("holes"), n.holes);
  visit(Field("shift_mm", "mm").anatomical(), n.shift_mm);
  visit(Field("shift_at_break_mm", "mm").anatomical(), n.shift_at_break_mm);
  visit(Field("shift_max_mm", "mm").anatomical(), n.shift_max_mm);
  visit(Field("tip_error_mm", "mm").anatomical(), n.tip_error_mm);
  visit(Field("remarks"), n.remarks);
}

void columns(auto& visit, record::Of<GlandMotion> auto& g) {
  using record::Field;
  visit(Field("shift_at_break_mm", "mm").anatomical(), g.shift_at_break_mm);
  visit(Field("shift_max_mm", "mm").anatomical(), g.shift_max_mm);
  visit(Field("shift_in_place_mm", "mm").anatomical(), g.shift_in_place_mm);
  visit(Field("shift_residual_mm", "mm").anatomical(), g.shift_residual_mm);
  visit(Field("coronal", "°").in("rotation_deg"), g.rotation_deg.y());
  visit(Field("sagittal", "°").in("rotation_deg"), g.rotation_deg.x());
  visit(Field("transverse", "°").in("rotation_deg"), g.rotation_deg.z());
  visit(Field("base_mm", "mm").anatomical(), g.base_mm);
  visit(Field("mid_mm", "mm").anatomical(), g.mid_mm);
  visit(Field("apex_mm", "mm").anatomical(), g.apex_mm);
  visit(Field("volume_change_percent", "%"), g.volume_change_percent);
}

void columns(auto& visit, record::Of<TargetShift> auto& t) {
  visit(record::Field("centroid", "mm"), t.centroid_mm);
  visit(record::Field("max", "mm"), t.largest_mm);
}

/// Everything but the probe and the needles in place, which only some runs have.
void columns(auto& visit, record::Of<Summary> auto& s) {
  using record::Field;
  visit(Field("version"), s.version);
  visit(Field("scenario"), s.scenario);
  visit(Field("nodes").in("mesh"), s.nodes);
  visit(Field("tets").in("mesh"), s.tets);
  visit(Field("steps"), s.steps);
  visit(Field("axial", "N").in("peak_force_N"), s.peak_axial_N);
  visit(Field("sagittal", "N").in("peak_force_N"), s.peak_sagittal_N);
  visit(Field("lateral", "N").in("peak_force_N"), s.peak_lateral_N);
  visit(Field("events"), s.events);
  visit(Field("tip_deflection_mm", "mm"), s.tip_deflection_mm);
  visit(Field("tip_error_mm", "mm").anatomical().since(2), s.tip_error_mm);
  std::optional<TargetShift> target;
  if (!s.target_shifts.empty()) target = {s.target_shift_centroid_mm, s.target_shift_max_mm};
  visit(Field("target_shift_mm", "mm"), target);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(s)>>) {
    s.target_shifts.clear();
    if (target) {
      s.target_shifts.push_back(*target);
      s.target_shift_centroid_mm = target->centroid_mm;
      s.target_shift_max_mm = target->largest_mm;
    }
  }
  visit(Field("gland").since(2), s.gland);
  visit(Field("force_balance").in("residual"), s.residual_force_balance);
  visit(Field("torque_balance").in("residual"), s.residual_torque_balance);
  visit(Field("p50", "µs").in("step_us"), s.step_us_p50);
  visit(Field("p99", "µs").in("step_us"), s.step_us_p99);
  visit(Field("p999", "µs").in("step_us"), s.step_us_p999);
  visit(Field("max", "µs").in("step_us"), s.step_us_max);
  visit(Field("contacts_max"), s.contacts_max);
  visit(Field("capacity").since(2), s.capacity);
  visit(Field("compliance_condition"), s.compliance_condition);
  visit(Field("mesh_blur_mm"), s.mesh_blur);
  visit(Field("mesh_changes").since(2), s.mesh_changes);
  visit(Field("warnings"), s.warnings);
}

}  // namespace stylet

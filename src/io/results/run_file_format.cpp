// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_file_format.hpp"

#include "model/digest.hpp"
#include "row_check.hpp"

#include <cmath>
#include <cstddef>

namespace stylet::results {
namespace {

/// An 8-bit enumeration whose names are to_string() of the values 0 … last.
template <class Enum>
h5::Handle enum_type(Enum last) {
  h5::Handle type(h5::check(H5Tenum_create(H5T_NATIVE_INT8), "create type"), H5Tclose);
  for (std::int8_t value = 0; value <= static_cast<std::int8_t>(last); ++value) {
    h5::check(H5Tenum_insert(type, to_string(static_cast<Enum>(value)), &value), "create type");
  }
  return type;
}

}  // namespace

std::uint32_t check_of(const StepRow& r) {
  return RowCheck()
      .numbers(r.time_s, r.dt_s, r.base_x_mm, r.base_y_mm, r.base_z_mm, r.base_qw, r.base_qx, r.base_qy, r.base_qz,
               r.base_depth_mm, r.force_axial_N, r.force_sagittal_N, r.force_lateral_N)
      .numbers(r.torque_x_Nmm, r.torque_y_Nmm, r.torque_z_Nmm, r.tip_x_mm, r.tip_y_mm, r.tip_z_mm, r.tip_state,
               r.contacts, r.sticking, r.iterations, r.step_us, r.rest_steps, r.flags)
      .value();
}

std::uint32_t check_of(const FrameRow& r, std::span<const float> displacement, std::span<const Vec3> needle,
                       std::span<const ContactRow> contacts) {
  RowCheck check;
  check.numbers(r.time_s, r.base_depth_mm, r.label, r.needle_first, r.needle_count, r.contact_first, r.contact_count);
  check.bytes(displacement.data(), displacement.size_bytes()).bytes(needle.data(), needle.size_bytes());
  for (const ContactRow& c : contacts) check.numbers(c.position_mm, c.force_N, c.arc_length_mm, c.sticking, c.tip);
  return check.value();
}

std::uint32_t check_of(const EventRow& r) {
  return RowCheck().numbers(r.kind, r.time_s, r.depth_mm, r.force_N, r.region).value();
}

std::uint32_t check_of(const ProbeRow& r) {
  return RowCheck()
      .numbers(r.time_s, r.depth_mm, r.lift_mm, r.tilt_deg, r.roll_deg, r.diameter_mm, r.balloon_mm)
      .value();
}

std::uint32_t check_of(const EndRow& r, int version) {
  RowCheck check;
  check.numbers(r.steps, r.frames, r.events, r.summary_bytes, r.summary_check);
  if (version >= kFirstWithSeeds) check.numbers(r.acts, r.doses);
  if (version >= kFirstWithProbe) check.numbers(r.probe_moves);
  return check.value();
}

std::uint32_t check_of(std::string_view summary) { return RowCheck().bytes(summary.data(), summary.size()).value(); }

StepRow to_row(const Step& s) {
  StepRow row;
  row.time_s = s.time_s;
  row.dt_s = s.dt_s;
  row.base_x_mm = s.base.origin.x();
  row.base_y_mm = s.base.origin.y();
  row.base_z_mm = s.base.origin.z();
  row.base_qw = s.base.rotation.w();
  row.base_qx = s.base.rotation.x();
  row.base_qy = s.base.rotation.y();
  row.base_qz = s.base.rotation.z();
  row.base_depth_mm = s.base_depth_mm;
  row.force_axial_N = s.force_axial_N;
  row.force_sagittal_N = s.force_sagittal_N;
  row.force_lateral_N = s.force_lateral_N;
  row.torque_x_Nmm = s.torque_Nmm.x();
  row.torque_y_Nmm = s.torque_Nmm.y();
  row.torque_z_Nmm = s.torque_Nmm.z();
  row.tip_x_mm = s.tip_mm.x();
  row.tip_y_mm = s.tip_mm.y();
  row.tip_z_mm = s.tip_mm.z();
  row.tip_state = static_cast<std::int8_t>(s.tip_state);
  row.contacts = s.contacts;
  row.sticking = s.sticking;
  row.iterations = s.iterations;
  row.step_us = s.step_us;
  row.rest_steps = s.rest_steps;
  row.flags = s.flags;
  row.check = check_of(row);
  return row;
}

Step from_row(const StepRow& row) {
  Step s;
  s.time_s = row.time_s;
  s.dt_s = row.dt_s;
  s.base.origin = {row.base_x_mm, row.base_y_mm, row.base_z_mm};
  s.base.rotation = Eigen::Quaterniond(row.base_qw, row.base_qx, row.base_qy, row.base_qz);
  s.base_depth_mm = row.base_depth_mm;
  s.force_axial_N = row.force_axial_N;
  s.force_sagittal_N = row.force_sagittal_N;
  s.force_lateral_N = row.force_lateral_N;
  s.torque_Nmm = {row.torque_x_Nmm, row.torque_y_Nmm, row.torque_z_Nmm};
  s.tip_mm = {row.tip_x_mm, row.tip_y_mm, row.tip_z_mm};
  s.tip_state = static_cast<TipState>(row.tip_state);
  s.contacts = row.contacts;
  s.sticking = row.sticking;
  s.iterations = row.iterations;
  s.step_us = row.step_us;
  s.rest_steps = row.rest_steps;
  s.flags = row.flags;
  return s;
}

h5::Handle step_row_type() {
  h5::Handle type = h5::compound_type(sizeof(StepRow));
  h5::insert_member(type, "time_s", offsetof(StepRow, time_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "dt_s", offsetof(StepRow, dt_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_x_mm", offsetof(StepRow, base_x_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_y_mm", offsetof(StepRow, base_y_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_z_mm", offsetof(StepRow, base_z_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_qw", offsetof(StepRow, base_qw), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_qx", offsetof(StepRow, base_qx), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_qy", offsetof(StepRow, base_qy), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_qz", offsetof(StepRow, base_qz), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_depth_mm", offsetof(StepRow, base_depth_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "force_axial_N", offsetof(StepRow, force_axial_N), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "force_sagittal_N", offsetof(StepRow, force_sagittal_N), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "force_lateral_N", offsetof(StepRow, force_lateral_N), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "torque_x_Nmm", offsetof(StepRow, torque_x_Nmm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "torque_y_Nmm", offsetof(StepRow, torque_y_Nmm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "torque_z_Nmm", offsetof(StepRow, torque_z_Nmm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "tip_x_mm", offsetof(StepRow, tip_x_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "tip_y_mm", offsetof(StepRow, tip_y_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "tip_z_mm", offsetof(StepRow, tip_z_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "tip_state", offsetof(StepRow, tip_state), enum_type(TipState::exited));
  h5::insert_member(type, "contacts", offsetof(StepRow, contacts), H5T_NATIVE_INT32);
  h5::insert_member(type, "sticking", offsetof(StepRow, sticking), H5T_NATIVE_INT32);
  h5::insert_member(type, "iterations", offsetof(StepRow, iterations), H5T_NATIVE_INT32);
  h5::insert_member(type, "step_us", offsetof(StepRow, step_us), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "rest_steps", offsetof(StepRow, rest_steps), H5T_NATIVE_INT64);
  h5::insert_member(type, "flags", offsetof(StepRow, flags), H5T_NATIVE_UINT32);
  h5::insert_member(type, "check", offsetof(StepRow, check), H5T_NATIVE_UINT32);
  return type;
}

h5::Handle frame_row_type() {
  h5::Handle type = h5::compound_type(sizeof(FrameRow));
  h5::insert_member(type, "time_s", offsetof(FrameRow, time_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_depth_mm", offsetof(FrameRow, base_depth_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "label", offsetof(FrameRow, label), h5::string_type(sizeof(FrameRow::label)));
  h5::insert_member(type, "needle_first", offsetof(FrameRow, needle_first), H5T_NATIVE_INT64);
  h5::insert_member(type, "needle_count", offsetof(FrameRow, needle_count), H5T_NATIVE_INT64);
  h5::insert_member(type, "contact_first", offsetof(FrameRow, contact_first), H5T_NATIVE_INT64);
  h5::insert_member(type, "contact_count", offsetof(FrameRow, contact_count), H5T_NATIVE_INT64);
  h5::insert_member(type, "check", offsetof(FrameRow, check), H5T_NATIVE_UINT32);
  return type;
}

ContactRow to_row(const ContactView& c) {
  ContactRow row;
  for (std::size_t k = 0; k < 3; ++k) {
    row.position_mm[k] = c.position[static_cast<Eigen::Index>(k)];
    row.force_N[k] = c.force[static_cast<Eigen::Index>(k)];
  }
  row.arc_length_mm = c.s;
  row.sticking = c.sticking ? 1 : 0;
  row.tip = c.tip ? 1 : 0;
  return row;
}

ContactView from_row(const ContactRow& row) {
  ContactView c;
  c.position = {row.position_mm[0], row.position_mm[1], row.position_mm[2]};
  c.force = {row.force_N[0], row.force_N[1], row.force_N[2]};
  c.s = row.arc_length_mm;
  c.sticking = row.sticking != 0;
  c.tip = row.tip != 0;
  return c;
}

h5::Handle contact_row_type() {
  h5::Handle type = h5::compound_type(sizeof(ContactRow));
  const h5::Handle vector = h5::array_type(H5T_NATIVE_DOUBLE, 3);
  h5::insert_member(type, "position_mm", offsetof(ContactRow, position_mm), vector);
  h5::insert_member(type, "force_N", offsetof(ContactRow, force_N), vector);
  h5::insert_member(type, "arc_length_mm", offsetof(ContactRow, arc_length_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "sticking", offsetof(ContactRow, sticking), h5::bool_type());
  h5::insert_member(type, "tip", offsetof(ContactRow, tip), h5::bool_type());
  return type;
}

EventRow to_row(const Event& event) {
  EventRow row;
  row.kind = static_cast<std::int8_t>(event.kind);
  row.time_s = event.time_s;
  row.depth_mm = event.depth_mm;
  row.force_N = event.force_N;
  put_text(row.region, event.region);
  row.check = check_of(row);
  return row;
}

Event from_row(const EventRow& row) {
  return {static_cast<EventKind>(row.kind), row.time_s, row.depth_mm, row.force_N, get_text(row.region)};
}

h5::Handle event_row_type() {
  h5::Handle type = h5::compound_type(sizeof(EventRow));
  h5::insert_member(type, "kind", offsetof(EventRow, kind), enum_type(EventKind::grazed));
  h5::insert_member(type, "time_s", offsetof(EventRow, time_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "depth_mm", offsetof(EventRow, depth_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "force_N", offsetof(EventRow, force_N), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "region", offsetof(EventRow, region), h5::string_type(sizeof(EventRow::region)));
  h5::insert_member(type, "check", offsetof(EventRow, check), H5T_NATIVE_UINT32);
  return type;
}

ProbeRow to_row(const ProbeMove& move) {
  ProbeRow row;
  row.time_s = move.time_s;
  row.depth_mm = move.probe.depth_mm.value_or(kMissing);
  row.lift_mm = move.probe.lift_mm;
  row.tilt_deg = move.probe.tilt_deg;
  row.roll_deg = move.probe.roll_deg;
  row.diameter_mm = move.probe.diameter_mm;
  row.balloon_mm = move.probe.balloon_mm;
  row.check = check_of(row);
  return row;
}

ProbeMove from_row(const ProbeRow& row, const ProbeSettings& planned) {
  ProbeMove move{row.time_s, planned};
  move.probe.depth_mm.reset();
  if (!std::isnan(row.depth_mm)) move.probe.depth_mm = row.depth_mm;
  move.probe.lift_mm = row.lift_mm;
  move.probe.tilt_deg = row.tilt_deg;
  move.probe.roll_deg = row.roll_deg;
  move.probe.diameter_mm = row.diameter_mm;
  move.probe.balloon_mm = row.balloon_mm;
  return move;
}

h5::Handle probe_row_type() {
  h5::Handle type = h5::compound_type(sizeof(ProbeRow));
  h5::insert_member(type, "time_s", offsetof(ProbeRow, time_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "depth_mm", offsetof(ProbeRow, depth_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "lift_mm", offsetof(ProbeRow, lift_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "tilt_deg", offsetof(ProbeRow, tilt_deg), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "roll_deg", offsetof(ProbeRow, roll_deg), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "diameter_mm", offsetof(ProbeRow, diameter_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "balloon_mm", offsetof(ProbeRow, balloon_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "check", offsetof(ProbeRow, check), H5T_NATIVE_UINT32);
  return type;
}

h5::Handle end_row_type() {
  h5::Handle type = h5::compound_type(sizeof(EndRow));
  h5::insert_member(type, "steps", offsetof(EndRow, steps), H5T_NATIVE_INT64);
  h5::insert_member(type, "frames", offsetof(EndRow, frames), H5T_NATIVE_INT64);
  h5::insert_member(type, "events", offsetof(EndRow, events), H5T_NATIVE_INT64);
  h5::insert_member(type, "summary_bytes", offsetof(EndRow, summary_bytes), H5T_NATIVE_INT64);
  h5::insert_member(type, "summary_check", offsetof(EndRow, summary_check), H5T_NATIVE_UINT32);
  h5::insert_member(type, "acts", offsetof(EndRow, acts), H5T_NATIVE_INT64);
  h5::insert_member(type, "doses", offsetof(EndRow, doses), H5T_NATIVE_INT64);
  h5::insert_member(type, "probe_moves", offsetof(EndRow, probe_moves), H5T_NATIVE_INT64);
  h5::insert_member(type, "check", offsetof(EndRow, check), H5T_NATIVE_UINT32);
  return type;
}

std::string start_digest(const RunInfo& info, const TetMesh& mesh) {
  detail::Digest digest;
  const auto add = [&](std::span<const std::string> texts) {
    for (const std::string& text : texts) digest.add(text);
  };
  add(std::array{info.version, info.scenario_name, info.scenario_text, info.method});
  for (const ParameterRow& p : info.parameters) add(std::array{p.name, p.value, p.unit, p.source});
  add(info.supports);
  add(info.warnings);
  digest.add(std::span<const double>(std::array{info.needle_diameter_mm, info.needle_length_mm}));
  digest.add(std::span<const int>(info.target_regions));
  for (const Vec3* v : {&info.entry_mm, &info.direction}) digest.add(std::span<const double>(v->data(), 3));
  digest.add_bytes(mesh.nodes.data(), mesh.nodes.size() * sizeof(Vec3));
  digest.add_bytes(mesh.tets.data(), mesh.tets.size() * sizeof(mesh.tets[0]));
  digest.add(std::span<const int>(mesh.tet_region));
  add(mesh.regions);
  return digest.finish();
}

}  // namespace stylet::results

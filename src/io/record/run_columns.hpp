// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/field.hpp"
#include "stylet/sim/probe_move.hpp"
#include "stylet/sim/recording.hpp"

#include <cstdint>

/// The fields of the records of an insertion. Their order is that of the columns in a file, from which the check of a
/// row is made: a new field of a row is the last one.
namespace stylet {

namespace results {

/// The row of a frame. Its needle points and contacts are consecutive rows of their own datasets.
struct FrameRow {
  double time_s = 0.0, base_depth_mm = 0.0;
  std::string label;
  std::int64_t needle_first = 0, needle_count = 0;
  std::int64_t contact_first = 0, contact_count = 0;
};

/// The last row that is written: the numbers of rows.
struct RunEnd {
  std::int64_t steps = 0, frames = 0, events = 0;
  std::int64_t summary_bytes = 0;
  std::uint32_t summary_check = 0;
  std::int64_t acts = 0, doses = 0;
  std::int64_t probe_moves = 0;
};

}  // namespace results

namespace record {
template <>
inline constexpr bool has_check<Step> = true;
template <>
inline constexpr bool has_check<Event> = true;
template <>
inline constexpr bool has_check<ProbeMove> = true;
template <>
inline constexpr bool has_check<results::FrameRow> = true;
template <>
inline constexpr bool has_check<results::RunEnd> = true;
}  // namespace record

void columns(auto& visit, record::Of<Step> auto& s) {
  using record::Field, record::kFile;
  visit(Field("time_s", "s", "simulated time at the end of the step"), s.time_s);
  visit(Field("dt_s", "s", "duration of the step").only(kFile).since(2).unknown_before(), s.dt_s);
  visit(Field("base{}_mm", "mm", "pose of the base: its place, LPS").only(kFile).since(2).apart().unknown_before(),
        s.base.origin);
  const Field turn = Field("", "", "its orientation, a quaternion").only(kFile).since(2).unknown_before();
  const std::array names{"base_qx", "base_qy", "base_qz", "base_qw"};
  for (const Eigen::Index k : {3, 0, 1, 2})
    visit(turn.named(names[static_cast<std::size_t>(k)]), s.base.rotation.coeffs()[k]);
  visit(Field("base_depth_mm", "mm",
              "how far the tip of a rigid, straight needle on the same base would lie beyond the entry point"),
        s.base_depth_mm);
  visit(Field("force_axial_N", "N",
              "force of the hand on the needle along the axis of the base, positive when pushing in")
            .digits(9),
        s.force_axial_N);
  visit(Field("force_sagittal_N", "N",
              "force of the hand across the needle, in the direction axial × lateral (towards posterior for a needle "
              "that goes to superior)")
            .digits(9),
        s.force_sagittal_N);
  visit(Field("force_lateral_N", "N", "force of the hand across the needle, towards the patient's left").digits(9),
        s.force_lateral_N);
  visit(Field("torque{}_Nmm", "N mm", "torque of the hand about the base point, LPS axes").digits(9).apart(),
        s.torque_Nmm);
  visit(Field("tip{}_mm", "mm", "position of the real tip, LPS").apart(), s.tip_mm);
  visit(Field("tip_state", "",
              "`air`, `pressing` (touches, does not cut), `cutting`, `in_track` (in tissue that is already cut), "
              "`bone`, `exited`"),
        s.tip_state);
  visit(Field("contacts", "", "number of contact points on the needle"), s.contacts);
  visit(Field("sticking", "", "number of these contacts that stick"), s.sticking);
  visit(Field("iterations", "", "iterations of the coupled solver"), s.iterations);
  visit(Field("step_us", "µs", "processor time of the step").digits(1), s.step_us);
  visit(Field("rest_steps", "", "number of steps at rest between the row before and this row").only(kFile).since(3),
        s.rest_steps);
  visit(Field("flags", "", "warnings of the step, with the bits of the C interface").only(kFile).since(4), s.flags);
}

void columns(auto& visit, record::Of<Event> auto& e) {
  using record::Field;
  visit(Field("kind", "", "kind of the event"), e.kind);
  visit(Field("time_s", "s", "simulated time"), e.time_s);
  visit(Field("depth_mm", "mm", "base depth at that moment"), e.depth_mm);
  visit(Field("force_N", "N", "axial force of the hand at that moment"), e.force_N);
  visit(Field("region", "", "region touched, punctured or entered; empty if the event has none").text(128), e.region);
}

void columns(auto& visit, record::Of<ContactView> auto& c) {
  using record::Field;
  visit(Field("position{}_mm", "mm", "position in the deformed tissue, LPS"), c.position);
  visit(Field("force{}_N", "N", "force of the needle on the tissue, LPS"), c.force);
  visit(Field("arc_length_mm", "mm", "arc length on the needle, from its base"), c.s);
  visit(Field("sticking", "", "whether the contact sticks"), c.sticking);
  visit(Field("tip", "", "whether it is the tip"), c.tip);
}

void columns(auto& visit, record::Of<ProbeMove> auto& m) {
  using record::Field;
  visit(Field("time_s", "s", "moment from which on the probe is there"), m.time_s);
  visit(Field("depth_mm", "mm", "LPS z of the transverse array; NaN: the middle of the gland"), m.probe.depth_mm);
  visit(Field("lift_mm", "mm", "motion to anterior"), m.probe.lift_mm);
  visit(Field("tilt_deg", "°", "as `probe.tilt_deg`"), m.probe.tilt_deg);
  visit(Field("roll_deg", "°", "as `probe.roll_deg`"), m.probe.roll_deg);
  visit(Field("diameter_mm", "mm", "diameter of the probe"), m.probe.diameter_mm);
  visit(Field("balloon_mm", "mm", "thickness of the water around it"), m.probe.balloon_mm);
}

void columns(auto& visit, record::Of<GlandStep> auto& g) {
  using record::Field;
  visit(Field("time_s", "s", "simulated time, as in `forces.csv`"), g.time_s);
  visit(Field("base_depth_mm", "mm", "base depth, as in `forces.csv`"), g.base_depth_mm);
  visit(Field("shift_LR_mm", "mm",
              "mean displacement of the gland, left–right: positive to the patient's left, negative to the right (x of "
              "LPS)"),
        g.shift_mm.x());
  visit(Field("shift_AP_mm", "mm",
              "the same, anterior–posterior: positive to posterior, negative to anterior (y of LPS)"),
        g.shift_mm.y());
  visit(
      Field("shift_SI_mm", "mm", "the same, superior–inferior: positive to superior, negative to inferior (z of LPS)"),
      g.shift_mm.z());
  visit(Field("rotation_coronal_deg", "°",
              "rotation in the coronal plane, about the AP axis: positive where the gland's base (its superior end) "
              "goes to the left"),
        g.rotation_deg.y());
  visit(Field("rotation_sagittal_deg", "°",
              "rotation in the sagittal plane, about the LR axis: positive where the gland's base goes to anterior"),
        g.rotation_deg.x());
  visit(Field("rotation_transverse_deg", "°",
              "rotation in the transverse plane, about the SI axis: positive where the gland's left side goes to "
              "posterior"),
        g.rotation_deg.z());
}

void columns(auto& visit, record::Of<RunInfo> auto& i) {
  using record::Field;
  visit(Field("version", "", "version of the program"), i.version);
  visit(Field("scenario_name", "", "name of the scenario"), i.scenario_name);
  visit(Field("method", "", "coupling method and rule"), i.method);
  visit(Field("needle_diameter_mm", "mm", "diameter of the needle"), i.needle_diameter_mm);
  visit(Field("needle_length_mm", "mm", "length of the needle"), i.needle_length_mm);
  visit(Field("entry{}_mm", "mm", "entry point of the insertion, LPS"), i.entry_mm);
  visit(Field("direction{}", "", "unit vector along which the needle goes in, LPS"), i.direction);
  visit(Field("target_regions", "", "indices of the regions that form the target"), i.target_regions);
}

namespace results {

void columns(auto& visit, record::Of<FrameRow> auto& f) {
  using record::Field;
  visit(Field("time_s", "s", "simulated time"), f.time_s);
  visit(Field("base_depth_mm", "mm", "base depth"), f.base_depth_mm);
  visit(Field("label", "", "name of the moment, such as `deepest`; empty in the regular series").text(64), f.label);
  visit(Field("needle_first", "", "first row of the frame in `/frames/needle_mm`"), f.needle_first);
  visit(Field("needle_count", "", "number of its rows there"), f.needle_count);
  visit(Field("contact_first", "", "first row of the frame in `/frames/contacts`"), f.contact_first);
  visit(Field("contact_count", "", "number of its rows there"), f.contact_count);
}

void columns(auto& visit, record::Of<RunEnd> auto& e) {
  using record::Field;
  visit(Field("steps", "", "number of rows of `/steps`"), e.steps);
  visit(Field("frames", "", "number of rows of `/frames/table`"), e.frames);
  visit(Field("events", "", "number of rows of `/events`"), e.events);
  visit(Field("summary_bytes", "", "length of `/summary_json`"), e.summary_bytes);
  visit(Field("summary_check", "", "CRC-32 of `/summary_json`"), e.summary_check);
  visit(Field("acts", "", "number of rows of `/implant/acts`").since(5), e.acts);
  visit(Field("doses", "", "number of rows of `/implant/doses`").since(5), e.doses);
  visit(Field("probe_moves", "", "number of rows of `/probe`").since(6), e.probe_moves);
}

}  // namespace results
}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/field.hpp"
#include "stylet/sim/probe_move.hpp"
#include "stylet/sim/recording.hpp"

#include <cstdint>

/// The fields of the records of an insertion; those of a step are beside Step (coupling/step.hpp). Their order is that
/// of the columns in a file, from which the check of a row is made: a new field of a row is the last one.
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
inline constexpr bool has_check<Event> = true;
template <>
inline constexpr bool has_check<ProbeMove> = true;
template <>
inline constexpr bool has_check<results::FrameRow> = true;
template <>
inline constexpr bool has_check<results::RunEnd> = true;
}  // namespace record

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

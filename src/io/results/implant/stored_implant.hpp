// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/wire.hpp"
#include "h5.hpp"
#include "run_file_format.hpp"
#include "stylet/io/implant_record_io.hpp"

#include <cstdint>
#include <string>

/// The format of the run.h5 of an implant (docs/results.md), shared by its writer and its reader.
namespace stylet::results {

inline constexpr int kImplantFileVersion = 2;
inline constexpr const char* kGiveAnImplant =
    "Give a run.h5 that `stylet implant` wrote; if it is damaged, use another copy or repeat the implant";

/// A row of /seeds.
struct SeedRow {
  std::int32_t number = 0;  ///< in the plan, from 1
  std::int32_t needle = 0;  ///< number of its group in /needles, from 0
  std::int8_t lost = 0, in_tissue = 0;
  double dropped_s = 0.0;
  std::array<double, 3> planned_mm{}, dropped_mm{}, rest_mm{}, axis{};
  std::array<std::array<double, 3>, kAllCauses> cause_mm{};
};
h5::Handle seed_row_type();
SeedRow to_row(const SeedHistory& seed);
SeedHistory from_row(const SeedRow& row);

/// A row of the shapes of a needle; row k belongs to shapes_mm[k].
struct ShapeRow {
  double time_s = 0.0, base_depth_mm = 0.0;
  std::array<char, 64> when{};
};
h5::Handle shape_row_type();

/// SHA-256 of the whole content of a record.
std::string content_digest(ImplantRecord& record);

/// Writes the record into a new file. Throws h5::Failure.
void write_stored_implant(const char* path, ImplantRecord& record);

/// Reads a whole file and compares its content with its digest. To be called in a child process, as parse_run_file().
Result<ImplantRecord> parse_implant_file(const std::filesystem::path& path);

}  // namespace stylet::results

// The fields that the file keeps, for the way from the child process to its parent (detail/wire.hpp) and for the
// digest.
namespace stylet {

void fields(auto& wire, Step& s) {
  auto& q = s.base.rotation.coeffs();
  wire(s.time_s, s.dt_s, s.base_depth_mm, s.base.origin, q.x(), q.y(), q.z(), q.w(), s.force_axial_N,
       s.force_sagittal_N, s.force_lateral_N, s.torque_Nmm, s.tip_mm, s.tip_state, s.contacts, s.sticking, s.iterations,
       s.step_us, s.rest_steps, s.flags);
}
void fields(auto& wire, Event& e) { wire(e.kind, e.time_s, e.depth_mm, e.force_N, e.region); }
void fields(auto& wire, NeedleShape& s) { wire(s.when, s.time_s, s.base_depth_mm, s.points_mm); }
void fields(auto& wire, NeedleRecord& r) { wire(r.group, r.steps, r.shapes); }
void fields(auto& wire, NeedleHistory& n) {
  wire(n.name, n.entry_mm, n.direction, n.depth_mm, n.peak_force_N, n.deflection_mm, n.gland_shift_mm, n.events,
       n.steps, n.seconds, n.record);
}
void fields(auto& wire, SeedHistory& s) {
  wire(s.number, s.needle, s.planned_mm, s.dropped_mm, s.rest_mm, s.axis, s.dropped_s, s.lost, s.in_tissue, s.cause_mm);
}
void fields(auto& wire, RecordedStructure& s) {
  wire(s.name, s.region, s.type, s.colour, s.volume_cc, s.contours, s.cloud_mm);
}
void fields(auto& wire, RecordedDose& d) {
  wire(d.grid.size, d.grid.origin_mm, d.grid.spacing_mm, d.grid.dose_Gy, d.dose_Gy, d.percent);
}
void fields(auto& wire, ImplantRecord& r) {
  wire(r.version, r.scenario_name, r.scenario_text, r.source, r.prescription_Gy, r.needle_diameter_mm,
       r.needle_length_mm, r.seed_length_mm, r.mesh, r.needles, r.stabilising, r.seeds, r.structures, r.planned,
       r.delivered, r.warnings, r.summary);
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "reading/task.hpp"
#include "record/wire_columns.hpp"
#include "run_file_format.hpp"
#include "stylet/io/implant_record_io.hpp"

#include <filesystem>

/// The format of the run.h5 of an implant (docs/results), shared by its writer and its reader.
namespace stylet::results {

/// Version of the format that is written: from 7 on in the same numbers as that of run.h5 of an insertion, of which the
/// file has the rows. Before, there were 1 and 2.
inline int implant_file_version() {
  return record::newest_version<Step, Event, NeedleShape, NeedleHistory, SeedHistory, RecordedStructure, RecordedDose,
                                ImplantRecord>();
}
inline constexpr const char* kGiveAnImplant =
    "Give a run.h5 that `stylet implant` wrote; if it is damaged, use another copy or repeat the implant";

/// Writes the record into a new file, for h5::written().
void write_stored_implant(const char* path, ImplantRecord record);

/// Reads a whole file and compares its content with its digest. To be called in the reading program, as
/// parse_run_file().
Result<ImplantRecord> parse_implant_file(const std::filesystem::path& path);
inline constexpr detail::Task<ImplantRecord> kImplantFile{"parse_implant_file", kGiveAnImplant};

/// Whether a file says that it is the recording of an implant. To be called in the reading program.
Result<bool> is_implant_file(const std::filesystem::path& path);
inline constexpr detail::Task<bool> kIsImplantFile{"is_implant_file", kGiveAnImplant};

}  // namespace stylet::results

// The fields that the file keeps, for the way from the reading program to the one that asked (detail/wire.hpp).
namespace stylet {

void fields(auto& wire, NeedleShape& s) {
  record::each_field<record::kFile>(s, [&](const record::Field&, auto& value) { wire(value); });
  wire(s.points_mm);
}
void fields(auto& wire, NeedleHistory& n) {
  record::each_field<record::kFile>(n, [&](const record::Field&, auto& value) { wire(value); });
  wire(n.events, n.record.steps, n.record.shapes);
}
void fields(auto& wire, RecordedStructure& s) {
  record::each_field<record::kFile>(s, [&](const record::Field&, auto& value) { wire(value); });
  wire(s.contours, s.cloud_mm);
}
void fields(auto& wire, RecordedDose& d) {
  wire(d.grid.size, d.grid.origin_mm, d.grid.spacing_mm, d.grid.dose_Gy, d.dose_Gy, d.percent);
}
void fields(auto& wire, ImplantRecord& r) {
  record::each_field<record::kFile>(r, [&](const record::Field&, auto& value) { wire(value); });
  wire(r.scenario_text, r.mesh, r.needles, r.stabilising, r.seeds, r.structures, r.planned, r.delivered, r.warnings,
       r.summary);
}

}  // namespace stylet

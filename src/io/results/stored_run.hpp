// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/wire.hpp"
#include "run_file_format.hpp"
#include "seed_tables.hpp"
#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet::results {

/// The cure in errors about a file that is not a recording or is damaged.
inline constexpr const char* kGiveARecording =
    "Give a run.h5 that stylet wrote; if it is damaged, use another copy or repeat the run";

/// The content of a run.h5 as stored, before the checks.
struct StoredRun {
  int format_version = 0;
  std::string start_digest;  ///< empty in files without checks
  RunInfo info;
  TetMesh mesh;
  std::vector<StepRow> steps;
  std::vector<FrameRow> frames;
  std::vector<float> displacement;  ///< [mm] (frames × 3n)
  std::vector<Vec3> needle;
  std::vector<ContactRow> contacts;
  std::vector<EventRow> events;
  std::vector<ProbeRow> probe_moves;
  StoredSeeds seeds;
  std::string summary;
  std::vector<EndRow> end;  ///< empty while the run goes on and if it was killed
};

/// Reads a run.h5 completely. To be called in a child process (detail/guard.hpp) while the parent holds an
/// h5::LibraryTurn, because HDF5 1.10 crashes on some damaged files.
Result<StoredRun> parse_run_file(const std::filesystem::path& path);

// Serialisation from the child process to its parent (detail/wire.hpp).
void fields(auto& wire, StoredSeeds& s) {
  wire(s.digest, s.needles, s.planned, s.current, s.seed_length_mm, s.seed_diameter_mm, s.prescription_Gy, s.source,
       s.acts, s.doses);
}
void fields(auto& wire, StoredRun& r) {
  wire(r.format_version, r.start_digest, r.info, r.mesh, r.steps, r.frames, r.displacement, r.needle, r.contacts,
       r.events, r.probe_moves, r.seeds, r.summary, r.end);
}

}  // namespace stylet::results

namespace stylet {

void fields(auto& wire, ParameterRow& p) { wire(p.name, p.value, p.unit, p.source); }
void fields(auto& wire, RunInfo& i) {
  wire(i.version, i.scenario_name, i.scenario_text, i.parameters, i.supports, i.warnings, i.method,
       i.needle_diameter_mm, i.needle_length_mm, i.target_regions, i.entry_mm, i.direction);
}

}  // namespace stylet

namespace stylet::detail {

template <>
inline constexpr bool is_plain<results::StepRow> = true;
template <>
inline constexpr bool is_plain<results::FrameRow> = true;
template <>
inline constexpr bool is_plain<results::ContactRow> = true;
template <>
inline constexpr bool is_plain<results::EventRow> = true;
template <>
inline constexpr bool is_plain<results::ProbeRow> = true;
template <>
inline constexpr bool is_plain<results::EndRow> = true;
template <>
inline constexpr bool is_plain<results::PlanNeedleRow> = true;
template <>
inline constexpr bool is_plain<results::PlanSeedRow> = true;
template <>
inline constexpr bool is_plain<results::ActRow> = true;
template <>
inline constexpr bool is_plain<results::DoseRow> = true;

}  // namespace stylet::detail

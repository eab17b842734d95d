// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "reading/task.hpp"
#include "record/wire_columns.hpp"
#include "run_file_format.hpp"
#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet::results {

/// The cure in errors about a file that is not a recording or is damaged.
inline constexpr const char* kGiveARecording =
    "Give a run.h5 that stylet wrote; if it is damaged, use another copy or repeat the run";

/// The group /implant as stored, before the checks. Without needles the file has none.
struct StoredSeeds {
  std::string digest;  ///< of the plan
  StoredPlan plan;
  record::Rows<SeedAct> acts;
  record::Rows<RecordedScore> doses;
};

/// The content of a run.h5 as stored, before the checks.
struct StoredRun {
  int format_version = 0;
  std::string start_digest;  ///< empty in files without checks
  RunInfo info;
  TetMesh mesh;
  record::Rows<Step> steps;
  record::Rows<FrameRow> frames;
  std::vector<float> displacement;  ///< [mm] (frames × 3n)
  std::vector<Vec3> needle;
  record::Rows<ContactView> contacts;
  record::Rows<Event> events;
  record::Rows<ProbeMove> probe_moves;
  StoredSeeds seeds;
  std::string summary;
  record::Rows<RunEnd> end;  ///< empty while the run goes on and if it was killed
};

/// The content of a run.h5 without what is long, as stored.
struct StoredHead {
  Error problem;  ///< why it could not be read; without a place if it could
  int format_version = 0;
  std::string scenario_name;
  record::Rows<Step> last_steps;
  double most_N = record::kNotANumber;  ///< largest axial force; not a number if the file has too many steps or seeds
  record::Rows<Event> events;
  StoredSeeds seeds;
  record::Rows<RunEnd> end;
};

/// Reads the heads of many files, as parse_run_file() one file completely.
/// @param first the first of them @param others the others
Result<std::vector<StoredHead>> parse_run_heads(const std::filesystem::path& first,
                                                const std::vector<std::string>& others);
inline constexpr detail::Task<std::vector<StoredHead>, std::vector<std::string>> kRunHeads{"parse_run_heads",
                                                                                           kGiveARecording};

/// Reads a run.h5 completely. To be called in the reading program (reading/ask.hpp), because HDF5 1.10 crashes on some
/// damaged files.
Result<StoredRun> parse_run_file(const std::filesystem::path& path);
inline constexpr detail::Task<StoredRun> kRunFile{"parse_run_file", kGiveARecording};

// Serialisation from the reading program to the one that asked (detail/wire.hpp).
void fields(auto& wire, StoredPlan& p) {
  record::each_field<record::kFile>(p.head, [&](const record::Field&, auto& value) { wire(value); });
  wire(p.needles, p.seeds);
}
void fields(auto& wire, StoredSeeds& s) { wire(s.digest, s.plan, s.acts, s.doses); }
void fields(auto& wire, StoredHead& h) {
  wire(h.problem, h.format_version, h.scenario_name, h.last_steps, h.most_N, h.events, h.seeds, h.end);
}
void fields(auto& wire, StoredRun& r) {
  wire(r.format_version, r.start_digest, r.info, r.mesh, r.steps, r.frames, r.displacement, r.needle, r.contacts,
       r.events, r.probe_moves, r.seeds, r.summary, r.end);
}

}  // namespace stylet::results

namespace stylet {

void fields(auto& wire, ParameterRow& p) { wire(p.name, p.value, p.unit, p.source); }
void fields(auto& wire, RunInfo& i) {
  record::each_field<record::kFile>(i, [&](const record::Field&, auto& value) { wire(value); });
  wire(i.scenario_text, i.parameters, i.supports, i.warnings);
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "record/implant_columns.hpp"
#include "record/rows.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <array>
#include <string>

/// The format of run.h5 (docs/results), shared by its writer and its reader. The columns of its rows are in
/// record/run_columns.hpp and record/implant_columns.hpp. Every row has a check: the CRC-32 of its other columns in
/// their order and, for a frame, of its displacement, needle points and contacts. A row with a wrong check has not
/// reached the disk completely, or has been changed.
namespace stylet::results {

/// Version of the format that is written. A file of a newer version is refused.
inline int run_file_version() {
  return record::newest_version<Step, Event, ContactView, ProbeMove, FrameRow, RunEnd, RunInfo, RecordedPlan,
                                RecordedPlan::Needle, RecordedPlan::Seed, SeedAct, RecordedScore>();
}
inline constexpr int kFirstWithChecks = 4;  ///< first version of the format with checks
inline constexpr int kFirstWithSeeds = 5;   ///< first version of the format that may have the seeds of an implant
inline constexpr int kFirstWithProbe = 6;   ///< first version of the format with the moves of a probe
inline constexpr const char* kRunFileFormat = "stylet-run";
inline constexpr const char* kImplantFileFormat = "stylet-implant";  ///< of the run.h5 of an implant

/// Columns of /parameters.
inline constexpr std::array kParameterColumns{"name", "value", "unit", "source"};

/// The displacements, needle points and contacts of a frame, which the check of its row covers beside its columns.
/// @param displacement (3n) @param needle points of the frame @param contacts bytes of their rows
inline std::array<std::span<const std::byte>, 3> parts_of_frame(std::span<const float> displacement,
                                                                std::span<const Vec3> needle,
                                                                std::string_view contacts) {
  return {std::as_bytes(displacement), std::as_bytes(needle), std::as_bytes(std::span(contacts))};
}

/// The plan of seeds as the group /implant has it.
struct StoredPlan {
  RecordedPlan head;  ///< without needles and seeds
  record::Rows<RecordedPlan::Needle> needles;
  record::Rows<RecordedPlan::Seed> seeds;
};
StoredPlan stored_plan(const RecordedPlan& plan);
/// SHA-256 of all of it, for the check of the group.
std::string plan_digest(const StoredPlan& plan);

/// SHA-256 of all data that are known before the first step, without the attributes about the format.
std::string start_digest(const RunInfo& info, const TetMesh& mesh);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "run_file_format.hpp"
#include "seed_tables.hpp"
#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

namespace stylet::results {

/// A frame with its displacement in single precision, as stored.
struct StoredFrame {
  Frame frame;                      ///< `frame.displacement` is not used
  std::vector<float> displacement;  ///< [mm] (3n)
};

/// Writes run.h5. create() writes all data that are known before the run and creates every dataset; the file is then in
/// SWMR mode (one writer, many readers) and only grows, so it can be read during the run and after the process was
/// killed at any moment. For one thread at a time.
class RunFileWriter {
 public:
  /// Creates the file. An earlier file at `path` is replaced only when all data that are known before the run have been
  /// written.
  /// @param make_way is called right before the replacement; if it fails, nothing is changed
  /// @param plan of the seeds that are dropped in this run; null: there is none
  static Result<RunFileWriter> create(const std::filesystem::path& path, const RunInfo& info, const TetMesh& mesh,
                                      const std::function<Result<>()>& make_way = {},
                                      const RecordedPlan* plan = nullptr);

  Result<> append_steps(std::span<const Step> steps);
  Result<> append_frame(const StoredFrame& stored);
  Result<> append_events(std::span<const Event> events);
  Result<> append_probe_moves(std::span<const ProbeMove> moves);
  /// Writes acts and doses of the plan that was given to create(); without a plan, nothing.
  Result<> append_seeds(std::span<const SeedAct> acts, std::span<const RecordedScore> doses);
  /// Writes the summary, and those of its events that are not in the file yet. To be called once, at the end.
  Result<> append_summary(const Summary& summary);
  Result<> flush();  ///< writes all appended data to the file
  Result<> close();  ///< writes /end and closes the file

 private:
  explicit RunFileWriter(std::filesystem::path path) : path_(std::move(path)) {}
  /// Runs `action` and converts exceptions of HDF5 to an Error that names the file.
  template <class Action>
  Result<> guarded(Action action) const;

  std::filesystem::path path_;
  h5::Handle file_;
  h5::Handle step_type_, frame_type_, contact_type_, event_type_, probe_type_, end_type_;
  h5::Handle steps_, frame_table_, displacement_, needle_, contacts_, events_, probe_, summary_, end_;
  std::optional<SeedTables> seeds_;
  std::int64_t needle_points_ = 0;
  std::int64_t contact_count_ = 0;
  EndRow written_;
};

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "run_file_format.hpp"
#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <functional>
#include <span>

namespace stylet::results {

/// A frame with its displacement as it is stored.
struct StoredFrame {
  Frame frame;                      ///< `frame.displacement` is not used
  std::vector<float> displacement;  ///< [mm] (3n)
};

/// Writes run.h5. Everything known before the run is written and every dataset created by create(); the file is then in
/// SWMR mode (one writer, many readers) and only grows, so it can be read while the run goes on and after the process
/// died at any moment. One thread at a time.
class RunFileWriter {
 public:
  /// The file takes its place when all that is known before the run is in it; until then an earlier one stays there.
  /// @param make_way called right before; where it fails, everything stays as it was
  static Result<RunFileWriter> create(const std::filesystem::path& path, const RunInfo& info, const TetMesh& mesh,
                                      const std::function<Result<>()>& make_way = {});

  Result<> append_steps(std::span<const Step> steps);
  Result<> append_frame(const StoredFrame& stored);
  Result<> append_events(std::span<const Event> events);
  Result<> append_summary(
      const Summary& summary);  ///< and those of its events that are not there yet; once, at the end
  Result<> flush();             ///< everything appended so far reaches the file
  Result<> close();             ///< says in the file how much there is

 private:
  explicit RunFileWriter(std::filesystem::path path) : path_(std::move(path)) {}
  /// Runs `action` and turns what HDF5 throws into an Error that names the file.
  template <class Action>
  Result<> guarded(Action action) const;

  std::filesystem::path path_;
  h5::Handle file_;
  h5::Handle step_type_, frame_type_, contact_type_, event_type_, end_type_;
  h5::Handle steps_, frame_table_, displacement_, needle_, contacts_, events_, summary_, end_;
  std::int64_t needle_points_ = 0;
  std::int64_t contact_count_ = 0;
  EndRow written_;
};

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "h5_new_file.hpp"
#include "run_file_format.hpp"
#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <functional>
#include <span>
#include <tuple>

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

  /// Writes steps, events, moves of the probe, acts of seeds or doses. Of acts and doses, nothing is written if no plan
  /// was given to create().
  template <class T>
  Result<> append(std::span<const T> records);
  Result<> append_frame(const StoredFrame& stored);
  /// Writes the summary, and those of its events that are not in the file yet. To be called once, at the end.
  Result<> append_summary(const Summary& summary);
  Result<> flush();  ///< writes all appended data to the file
  Result<> sync();   ///< waits until all flushed data are on the disk
  Result<> close();  ///< writes /end and closes the file

 private:
  explicit RunFileWriter(std::filesystem::path path) : path_(std::move(path)) {}
  /// Runs `action` and converts exceptions of HDF5 and of the disk to an Error that names the file.
  template <class Action>
  Result<> guarded(Action action) const;

  std::filesystem::path path_;
  h5::NewFile file_;
  template <class T>
  record::Table<T>& table() {
    return std::get<record::Table<T>>(tables_);
  }
  std::tuple<record::Table<Step>, record::Table<FrameRow>, record::Table<ContactView>, record::Table<Event>,
             record::Table<ProbeMove>, record::Table<SeedAct>, record::Table<RecordedScore>, record::Table<RunEnd>>
      tables_;
  h5::Handle displacement_, needle_, summary_;
  std::int64_t needle_points_ = 0;
  RunEnd written_;
};

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "run_file_writer.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <tuple>
#include <vector>

namespace stylet::results {

/// Writes steps, frames, events and changes of seeds to run.h5 in a thread of its own, so that the run never waits for
/// the disk, and added data are in the file after at most two periods even while the run is busy.
class Recorder {
 public:
  explicit Recorder(RunFileWriter writer);
  ~Recorder();

  /// Adds a step, a frame, an event, a move of the probe, an act of a seed or a dose. Returns the first error of the
  /// thread, if there was one.
  template <class T>
  Result<> add(T record) {
    const std::lock_guard lock(mutex_);
    if (error_) return *error_;
    std::get<std::vector<T>>(pending_).push_back(std::move(record));
    return Ok{};
  }

  /// Writes what has been added at once. Returns when it is in the file, after an error, or when `most` has passed.
  void write_now(std::chrono::milliseconds most);

  /// Writes the remaining data and the summary, if given, and closes the file. Nothing can be added afterwards.
  Result<> close(const Summary* summary);

 private:
  void run(const std::stop_token& stop);
  Result<> write_pending();

  RunFileWriter writer_;  ///< used only by the thread until it has ended
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable answer_;
  std::uint64_t asked_ = 0;     ///< number of calls of write_now()
  std::uint64_t answered_ = 0;  ///< number of those whose data are in the file
  using Pending = std::tuple<std::vector<Step>, std::vector<StoredFrame>, std::vector<Event>, std::vector<ProbeMove>,
                             std::vector<SeedAct>, std::vector<RecordedScore>>;
  Pending pending_;             ///< not yet written
  std::optional<Error> error_;  ///< first failure of the thread
  bool closed_ = false;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "run_file_writer.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace stylet::results {

/// Writes steps, frames, events and changes of seeds to run.h5 in a thread of its own, so that the run never waits for
/// the disk, and added data are in the file after at most two periods even while the run is busy.
class Recorder {
 public:
  explicit Recorder(RunFileWriter writer);
  ~Recorder();

  // All functions return the first error of the thread, if there was one.
  Result<> add_step(const Step& step);
  Result<> add_frame(StoredFrame frame);
  Result<> add_event(const Event& event);
  Result<> add_probe_move(const ProbeMove& move);
  Result<> add_act(const SeedAct& act);
  Result<> add_dose(const RecordedScore& dose);

  /// Writes the remaining data and the summary, if given, and closes the file. Nothing can be added afterwards.
  Result<> close(const Summary* summary);

 private:
  void run(const std::stop_token& stop);
  Result<> write_pending();

  RunFileWriter writer_;  ///< used only by the thread until it has ended
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<Step> steps_;           ///< not yet written
  std::vector<StoredFrame> frames_;   ///< not yet written
  std::vector<Event> events_;         ///< not yet written
  std::vector<ProbeMove> moves_;      ///< not yet written
  std::vector<SeedAct> acts_;         ///< not yet written
  std::vector<RecordedScore> doses_;  ///< not yet written
  std::optional<Error> error_;        ///< first failure of the thread
  bool closed_ = false;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::results

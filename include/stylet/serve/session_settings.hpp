// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/realtime/runner.hpp"
#include "stylet/serve/companion.hpp"
#include "stylet/serve/implant_case.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace stylet::serve {

/// A case that has been opened.
struct LoadedCase {
  std::shared_ptr<const Model> model;
  std::vector<std::string> notes;  ///< things left out, added or corrected when the model was made
  /// A plan of seeds to carry out; null: the case has none. The model may have any needle.
  std::shared_ptr<const ImplantCase> implant{};
};

/// A case that can be opened: a scenario file or a saved model.
struct CaseSource {
  std::string title;
  std::function<Result<LoadedCase>(const Progress&)> load;
};

struct SessionSettings {
  std::vector<CaseSource> cases;      ///< the first is opened; may be empty only with `replay`
  std::filesystem::path recordings;   ///< folder; every insertion makes a folder with run.h5 in it
  std::filesystem::path archive;      ///< another folder with recordings, which is only read; may be empty
  std::string replay;                 ///< name of a recording to start with; empty: live
  RunnerSettings runner;              ///< keep_steps is set by the session
  double pictures_per_s = 60.0;       ///< [1/s] highest rate of pictures
  double field_waits_s = 3.0;         ///< [s] longest wait for a page to draw before the displacement field is prepared
  double recorded_frames_per_s = 10;  ///< [1/s] highest rate of recorded frames; lower if frames take long to compute
  std::shared_ptr<Companion> companion;  ///< may be null
  /// Limit of all recordings together; the oldest are removed first; 0: no limit.
  std::uintmax_t keep_bytes = 5'000'000'000;
  double room_every_s = 2.0;  ///< [s] period of the check of this limit and of the free disk space
  /// Returns the free bytes of the disk that holds a folder; empty: asks the system.
  std::function<std::uintmax_t(const std::filesystem::path&)> free_bytes;
  /// Receives messages about removed recordings and full disks, for the terminal; may be empty. Called from any thread.
  std::function<void(const std::string&)> say;
  /// Receives what the server has done and how long it took, for a log; may be empty. Called from the session's thread.
  std::function<void(const std::string&)> log;
};

}  // namespace stylet::serve

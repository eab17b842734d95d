// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/io/recording_io.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace stylet::serve {

/// The folder of recordings; each recording is a folder with run.h5. There may be an archive, a second such folder that
/// is only read.
class Shelf {
 public:
  explicit Shelf(std::filesystem::path folder, std::filesystem::path archive = {})
      : folder_(std::move(folder)), archive_(std::move(archive)) {}

  /// An unused name: local date and time, and `of`, the name of the insertion.
  [[nodiscard]] std::string new_name(const std::string& of) const;
  /// Whether a name has the form that new_name() makes.
  [[nodiscard]] static bool is_own_name(const std::string& name);
  /// The folder of a recording that exists or is to be made.
  [[nodiscard]] std::filesystem::path folder(const std::string& name) const;
  /// The names of all recordings, newest first.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Reads a recording. Errors: no recording of this name (a path is not a name), and the errors of read_recording().
  [[nodiscard]] Result<RunRecording> read(const std::string& name) const;
  /// The heads of recordings whose names are known.
  [[nodiscard]] std::vector<Result<RecordingHead>> heads(std::span<const std::string> names) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path archive_;  ///< may be empty
};

}  // namespace stylet::serve

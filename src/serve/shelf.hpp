// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/io/recording_io.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet::serve {

/// The folder with the recordings, one folder for each, with its run.h5; and maybe another one, which is only read.
class Shelf {
 public:
  explicit Shelf(std::filesystem::path folder, std::filesystem::path archive = {})
      : folder_(std::move(folder)), archive_(std::move(archive)) {}

  /// A name that nothing has yet: local date and time, and what it is of.
  [[nodiscard]] std::string new_name(const std::string& of) const;
  /// Whether new_name() makes such names.
  [[nodiscard]] static bool is_own_name(const std::string& name);
  /// That of a recording, there or to be made.
  [[nodiscard]] std::filesystem::path folder(const std::string& name) const;
  /// Newest first.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Errors: no such recording (a name is never a path), and those of read_recording().
  [[nodiscard]] Result<RunRecording> read(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path archive_;  ///< may be empty
};

}  // namespace stylet::serve

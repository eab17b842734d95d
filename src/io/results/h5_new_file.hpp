// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "h5.hpp"
#include "stylet/core/result.hpp"

#include <filesystem>
#include <functional>
#include <memory>

namespace stylet::h5 {

/// A file that is created and written with HDF5. HDF5 1.10 crashes when it closes a file to which it could not write,
/// at the latest when the program ends. So HDF5 is told of no such failure: from the first one on, the file on the disk
/// stays as it is, like that of a process killed at this moment, and what follows is kept in memory until the file is
/// closed. check() and close() tell of the failure.
class NewFile {
 public:
  NewFile() = default;
  /// Creates the file in the latest format, in which all metadata have checksums. An existing file is replaced. Neither
  /// the file nor its objects have time stamps, so that the same content gives the same bytes. Throws Failure.
  explicit NewFile(const char* path);

  operator hid_t() const { return file_; }  // NOLINT(google-explicit-constructor): is used as the identifier
  /// Throws std::system_error if something could not be written.
  void check() const;
  /// Closes the file. Throws as check(), and Failure.
  void close();

 private:
  std::shared_ptr<int> reason_;  ///< errno of the first write that failed; 0: none
  Handle file_;
};

/// Runs `write` while this thread has HDF5 to itself. Its exceptions become an Error that names the file at `path`.
Result<> written(const std::filesystem::path& path, const std::function<void()>& write);

}  // namespace stylet::h5

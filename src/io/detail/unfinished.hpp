// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <optional>

namespace stylet::detail {

/// A file or folder that is being written, under a hidden name beside its final one, which it gets when all of it is on
/// the disk. It is removed with this object if it was not finished. A process that was killed leaves it behind; the
/// next process that writes into the same folder removes it. A lock shows that it is still in use.
class Unfinished {
 public:
  enum class Kind { file, private_file, folder };  ///< a private file can be read and written by its owner only

  /// Creates it, empty.
  /// @param path its final name, in a folder that exists
  static Result<Unfinished> create(const std::filesystem::path& path, Kind kind);
  /// The same, with the reason of the system for a failure. @param reason errno of the call that failed
  static std::optional<Unfinished> create(const std::filesystem::path& path, Kind kind, int& reason);
  ~Unfinished();
  Unfinished(Unfinished&& other) noexcept;
  Unfinished& operator=(Unfinished&&) = delete;

  /// Where it is until it is finished.
  [[nodiscard]] const std::filesystem::path& path() const { return hidden_; }
  /// A file, open for reading and writing; a folder, open for reading.
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// Waits until it is on the disk and gives it its final name; a file of that name is replaced. To be called once.
  Result<> finish();

 private:
  Unfinished(std::filesystem::path path, std::filesystem::path hidden, int descriptor);
  std::filesystem::path path_, hidden_;
  int descriptor_ = -1;  ///< holds the lock
};

/// Whether a file or folder has the name of an unfinished one.
bool is_unfinished(const std::filesystem::path& path);

}  // namespace stylet::detail

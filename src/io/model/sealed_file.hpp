// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stylet::detail {

/// Exception about a damaged sealed file; what() is a clause of a message.
struct NotSealed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file with an index and a seal at its end. The index is a text that gives the positions of the file's parts; the
/// seal is a mark, the length of the index and a SHA-256 of all bytes before the digest. Opening the file verifies that
/// it has exactly the bytes that were written, before any library parses it; its parts are then read by their
/// positions.
class SealedFile {
 public:
  /// Appends index and seal to a file. Throws std::system_error on an error of the disk.
  static void seal(const std::filesystem::path& path, const std::string& index);
  /// Whether a file ends with the mark of a seal; it may still be damaged.
  static bool is_marked(const std::filesystem::path& path);

  /// Opens a file and verifies its digest, which reads the whole file. Throws NotSealed.
  /// @param progress is called with the share that has been read, 0…1
  SealedFile(const std::filesystem::path& path, const std::function<void(double)>& progress);

  /// The index as given to seal().
  [[nodiscard]] const std::string& index() const { return index_; }
  /// Number of bytes before the index.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Reads bytes. Throws NotSealed if not all of them are before the index.
  void read(std::uint64_t at, std::uint64_t bytes, void* to) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::string index_;
  std::uint64_t size_ = 0;
};

}  // namespace stylet::detail

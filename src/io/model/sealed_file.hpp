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

/// What is wrong with a sealed file, as a clause.
struct NotSealed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file followed by a text that says where its parts lie, and by a seal: a mark, the length of that text and a
/// SHA-256 of every byte before itself. Whoever has opened one has exactly the bytes that were written, and reads them
/// by their places: no library looks at the file before they have been checked, and none needs to after that.
class SealedFile {
 public:
  /// Puts text and seal behind what is in a file. Throws NotSealed where the disk refuses.
  static void seal(const std::filesystem::path& path, const std::string& index);
  /// Whether a file ends with the mark of a seal; it may still be damaged.
  static bool is_marked(const std::filesystem::path& path);

  /// Reads all of the file once. Throws NotSealed.
  /// @param progress called with the share that has been read, 0…1
  SealedFile(const std::filesystem::path& path, const std::function<void(double)>& progress);

  /// The text, as given to seal().
  [[nodiscard]] const std::string& index() const { return index_; }
  /// [bytes] before the text.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Throws NotSealed where the bytes are not all before the text.
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

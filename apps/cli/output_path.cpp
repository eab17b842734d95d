// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_path.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace stylet::cli {

namespace fs = std::filesystem;

namespace {

/// The folder of a file; the current folder for a file name without folder.
fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

constexpr const char* kCure = "Choose another place with -o or --json";

/// Writes a small file into a folder and removes it, since permissions alone do not say whether the disk is full or
/// may only be read. @param wanted the output for which this is tried
Result<> try_to_write(const fs::path& folder, const fs::path& wanted) {
  constexpr std::size_t longest_name = 255;
  for (const fs::path& part : wanted) {
    if (part.string().size() > longest_name)
      return input_error(wanted.string(), fmt::format("a name in it has more than {} bytes", longest_name), kCure);
  }
  std::string name = (folder / ".stylet.XXXXXX").string();
  errno = 0;
  const int file = ::mkstemp(name.data());
  int reason = errno;
  if (file >= 0) {
    const std::string some(4096, ' ');
    errno = 0;
    const bool written =
        ::write(file, some.data(), some.size()) == static_cast<ssize_t>(some.size()) && ::fsync(file) == 0;
    reason = written ? 0 : errno != 0 ? errno : ENOSPC;
    ::close(file);
    ::unlink(name.c_str());
  }
  if (reason == 0) return Ok{};
  return input_error(wanted.string(),
                     fmt::format("the folder '{}' is not writable ({})", folder.string(), std::strerror(reason)),
                     kCure);
}

}  // namespace

Result<> check_output_folder(const fs::path& path) {
  if (path.empty()) return input_error("output folder", "the name is empty", kCure);
  // The deepest part of the path that exists decides whether the rest can be made.
  fs::path existing = fs::absolute(path).lexically_normal();
  std::error_code code;
  while (!fs::exists(fs::status(existing, code)) && existing.has_relative_path()) existing = existing.parent_path();
  if (!fs::is_directory(existing, code)) {
    return input_error(path.string(), fmt::format("'{}' is not a folder", existing.string()), kCure);
  }
  return try_to_write(existing, path);
}

Result<> check_output_file(const fs::path& path) {
  if (path.empty()) return input_error("output file", "the name is empty", kCure);
  std::error_code code;
  if (!path.has_filename() || fs::is_directory(path, code)) {
    return input_error(path.string(), "this is a folder; the name of a file is expected", kCure);
  }
  const Result<> folder = check_output_folder(folder_of(path));
  if (!folder) return input_error(path.string(), folder.error().what, folder.error().cure);
  return Ok{};
}

Result<> make_folder(const fs::path& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (!fs::is_directory(path)) {
    return input_error(path.string(), fmt::format("the folder cannot be created: {}", code.message()), kCure);
  }
  return Ok{};
}

Result<> write_text_file(const fs::path& path, std::string_view text) {
  if (Result<> made = make_folder(folder_of(path)); !made) return made;
  std::error_code code;
  if (fs::exists(path, code) &&
      !fs::is_regular_file(path, code)) {  // a pipe or a device must not be replaced by a file
    std::ofstream stream(path, std::ios::binary);
    stream << text << std::flush;
    if (!stream) return failure(path.string(), "writing failed", kCure);
    return Ok{};
  }
  const fs::path temporary = folder_of(path) / fmt::format(".{}.{}.part", path.filename().string(), ::getpid());
  {
    std::ofstream file(temporary, std::ios::binary);
    file << text << std::flush;
    if (!file) {
      file.close();
      fs::remove(temporary, code);
      return failure(path.string(), "writing failed", "Check the space and the permissions of its folder");
    }
  }
  fs::rename(temporary, path, code);
  if (code) {
    const std::string reason = code.message();
    fs::remove(temporary, code);
    return failure(path.string(), "the finished file cannot be renamed to its name: " + reason, kCure);
  }
  return Ok{};
}

}  // namespace stylet::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_path.hpp"

#include "stylet/io/files.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace fs = std::filesystem;

namespace {

/// The folder of a file; the current folder for a file name without folder.
fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

constexpr const char* kCure = "Choose another place with -o or --json";

/// Checks that a folder takes files. @param wanted the output for which it is needed, which errors name
Result<> check_for(const fs::path& folder, const fs::path& wanted) {
  constexpr std::size_t longest_name = 255;
  for (const fs::path& part : wanted) {
    if (part.string().size() > longest_name)
      return input_error(wanted.string(), fmt::format("a name in it has more than {} bytes", longest_name), kCure);
  }
  const Result<> writable = check_writable(folder);
  if (writable) return Ok{};
  return Error{writable.error().kind, wanted.string(), writable.error().what,
               writable.error().kind == ErrorKind::input ? kCure : writable.error().cure};
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
  return check_for(existing, path);
}

Result<> check_output_file(const fs::path& path) {
  if (path.empty()) return input_error("output file", "the name is empty", kCure);
  std::error_code code;
  if (!path.has_filename() || fs::is_directory(path, code)) {
    return input_error(path.string(), "this is a folder; the name of a file is expected", kCure);
  }
  const Result<> folder = check_output_folder(folder_of(path));
  if (folder) return Ok{};
  return Error{folder.error().kind, path.string(), folder.error().what, folder.error().cure};
}

Result<> write_text_file(const fs::path& path, std::string_view text) {
  if (Result<> made = make_folder(folder_of(path)); !made) return made;
  return write_whole_file(path, text);
}

}  // namespace stylet::cli

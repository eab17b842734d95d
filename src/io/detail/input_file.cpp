// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

const char* what_it_is(fs::file_type type) {
  switch (type) {
    case fs::file_type::fifo:
      return "a named pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    default:
      return "something else";
  }
}

/// Whether `inner` is in `folder` or below it. Both paths must be free of symbolic links.
bool is_below(const fs::path& inner, const fs::path& folder) {
  const auto [rest, unused] = std::mismatch(folder.begin(), folder.end(), inner.begin(), inner.end());
  return rest == folder.end();
}

}  // namespace

Result<> check_input_file(const fs::path& path) {
  const std::string where = path.string();
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) {
    return input_error(where, code && code != std::errc::no_such_file_or_directory ? code.message() : "no such file",
                       "Check the name and the folder");
  }
  if (fs::is_directory(status)) return input_error(where, "this is a folder, a file is expected", "Name a file in it");
  if (!fs::is_regular_file(status)) {
    return input_error(where, fmt::format("this is {}, not a regular file", what_it_is(status.type())),
                       "Copy the data to a file first");
  }
  if (!std::ifstream(path, std::ios::binary)) {
    return input_error(where, fmt::format("the file cannot be opened ({})", std::strerror(errno)),
                       "Check its permissions");
  }
  return Ok{};
}

Result<fs::path> data_file_of(const fs::path& header, const std::string& name) {
  const auto refuse = [&](const std::string& what) {
    return input_error(header.string(), fmt::format("the header names '{}' as its data file: {}", name, what),
                       "Keep header and data in one folder, and name the data file without a path");
  };
  const fs::path given(name);
  if (given.is_absolute()) return refuse("an absolute path is not followed");
  if (std::find(given.begin(), given.end(), fs::path("..")) != given.end()) {
    return refuse("a path out of the header's folder is not followed");
  }
  const fs::path folder = header.has_parent_path() ? header.parent_path() : fs::path(".");
  const fs::path path = folder / given;
  if (Result<> file = check_input_file(path); !file) return refuse(file.error().what);
  std::error_code code;
  const fs::path real_folder = fs::canonical(folder, code), real_path = code ? path : fs::canonical(path, code);
  if (code) return refuse(code.message());
  if (!is_below(real_path, real_folder)) return refuse("it is a link that leads out of the header's folder");
  return path;
}

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/input_file.hpp"

#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
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

/// The names in a folder; not all of them if it has very many.
std::vector<std::string> names_in(const fs::path& folder) {
  constexpr std::size_t most = 10'000;
  std::vector<std::string> names;
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end && names.size() < most; at.increment(code))
    names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string small(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The name without its extension; that of "case.nii.gz" is "case".
std::string stem_of(const std::string& name) { return small(name.substr(0, name.find('.', 1))); }

/// The names that a mistyped one may stand for, best first: other case, other or missing extension, typing errors.
std::vector<std::string> near_names(const std::string& mistyped, const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  std::vector<std::string> near;
  const auto add = [&](const std::string& name) {
    if (near.size() < most && !name.empty() && std::find(near.begin(), near.end(), name) == near.end())
      near.push_back(name);
  };
  for (const std::string& name : names)
    if (small(name) == small(mistyped)) add(name);
  if (near.empty()) {
    for (const std::string& name : names)
      if (stem_of(name) == stem_of(mistyped)) add(name);
    add(nearest_name(mistyped, names));
  }
  return near;
}

/// "; did you mean 'plan.dcm'?" from the names of the folder in which a path leads nowhere; empty if none is near.
std::string did_you_mean(const fs::path& path) {
  // The first part of the path that does not exist is the one that is mistyped.
  fs::path folder;
  std::error_code code;
  for (auto part = path.begin(); part != path.end(); ++part) {
    const fs::path next = folder / *part;
    if (fs::exists(next, code)) {
      folder = next;
      continue;
    }
    if (fs::is_regular_file(folder, code)) return fmt::format("; '{}' is a file, not a folder", folder.string());
    const bool is_last = std::next(part) == path.end();
    const auto near = near_names(part->string(), names_in(folder.empty() ? fs::path(".") : folder));
    std::vector<std::string> said;
    fs::path rest;
    for (auto later = std::next(part); later != path.end(); ++later) rest /= *later;
    for (const std::string& name : near) {
      const fs::path whole = folder / name / rest;  // the file itself, if only the folder's name is wrong
      said.push_back(fmt::format("'{}'", (is_last || !fs::exists(whole, code) ? folder / name : whole).string()));
    }
    const std::string lost = is_last ? "" : fmt::format(", because there is no folder '{}'", next.string());
    return said.empty() ? lost : fmt::format("{}; did you mean {}?", lost, fmt::join(said, " or "));
  }
  return {};
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
    const bool absent = !code || code == std::errc::no_such_file_or_directory || code == std::errc::not_a_directory;
    return input_error(where, absent ? "no such file" + did_you_mean(path) : code.message(),
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.hpp"

#include "detail/unfinished.hpp"
#include "stylet/core/printable.hpp"
#include "stylet/io/files.hpp"

#include <fmt/format.h>

#include <charconv>

namespace stylet::results {
namespace fs = std::filesystem;

namespace {

Result<> write_all(const std::vector<File>& files, const fs::path& folder) {
  for (const File& file : files) {
    if (auto done = write_whole_file(folder / file.name, file.content); !done) return done;
  }
  return Ok{};
}

/// Writes the files into a folder with a hidden name, which is then renamed to `folder` in one step.
Result<> write_new_folder(const std::vector<File>& files, const fs::path& folder) {
  if (auto ready = prepare_folder(folder.has_parent_path() ? folder.parent_path() : "."); !ready) return ready;
  auto hidden = detail::Unfinished::create(folder, detail::Unfinished::Kind::folder);
  if (!hidden) return hidden.error();
  if (auto done = write_all(files, hidden->path()); !done) {
    Error error = done.error();  // of the place that the user knows
    error.where = (folder / fs::path(error.where).filename()).string();
    return error;
  }
  return hidden->finish();
}

}  // namespace

Result<> prepare_folder(const fs::path& folder) {
  if (auto made = make_folder(folder); !made) return made;
  return check_writable(folder);
}

Result<> write_folder(const std::vector<File>& files, const fs::path& folder) {
  // "out/" and "out" are the same folder.
  const fs::path place = folder.has_filename() ? folder : folder.parent_path();
  std::error_code code;
  if (!fs::exists(place, code)) return write_new_folder(files, place);
  if (auto ready = prepare_folder(place); !ready) return ready;
  if (!files.empty()) fs::remove(place / files.back().name, code);
  return write_all(files, place);
}

std::string csv_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : printable_lines(text)) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string series_name(std::string_view stem, std::size_t number, std::string_view extension) {
  return fmt::format("{}_{:04}{}", stem, number, extension);
}

Result<> remove_earlier(const fs::path& path) {
  std::error_code code;
  fs::remove(path, code);
  if (!code) return Ok{};
  return input_error(path.string(), "this file of an earlier run cannot be removed: " + code.message(),
                     "Choose another folder with -o, or remove it");
}

Result<> remove_series_from(const fs::path& folder, std::string_view stem, std::string_view extension,
                            std::size_t first) {
  std::vector<fs::path> found;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= stem.size() + 1 + extension.size() || !name.starts_with(stem) || !name.ends_with(extension) ||
        name[stem.size()] != '_') {
      continue;
    }
    const char* digits = name.data() + stem.size() + 1;
    const char* behind = name.data() + name.size() - extension.size();
    std::size_t number = 0;
    const auto parsed = std::from_chars(digits, behind, number);
    if (parsed.ec == std::errc{} && parsed.ptr == behind && number >= first &&
        name == series_name(stem, number, extension)) {
      found.push_back(entry->path());
    }
  }
  for (const fs::path& path : found) {
    if (auto removed = remove_earlier(path); !removed) return removed;
  }
  return Ok{};
}

}  // namespace stylet::results

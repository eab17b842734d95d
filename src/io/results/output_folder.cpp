// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.hpp"

#include "detail/whole_file.hpp"
#include "stylet/core/printable.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>

namespace stylet::results {
namespace fs = std::filesystem;

namespace {

/// The reason of a failed stream operation, taken before anything else can change errno.
std::string system_reason() { return std::strerror(errno); }

Result<> write_all(const std::vector<File>& files, const fs::path& folder) {
  for (const File& file : files) {
    if (auto done = write_file(folder / file.name, file.content); !done) return done;
  }
  return Ok{};
}

/// Writes the files into a folder with a hidden name, which is then renamed to `folder` in one step.
Result<> write_new_folder(const std::vector<File>& files, const fs::path& folder) {
  const fs::path parent = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
  if (auto ready = prepare_folder(parent); !ready) return ready;
  const fs::path hidden = parent / fmt::format(".{}.{}.part", folder.filename().string(), ::getpid());
  std::error_code code;
  fs::create_directory(hidden, code);
  if (code) return write_error(hidden, code.message());
  Result<> done = write_all(files, hidden);
  if (done) {
    fs::rename(hidden, folder, code);
    if (code) done = write_error(folder, code.message());
  }
  std::error_code ignored;
  if (!done) fs::remove_all(hidden, ignored);
  return done;
}

}  // namespace

Error write_error(const fs::path& path, const std::string& reason) {
  return failure(path.string(), "cannot be written: " + reason,
                 "Check the free space and the permissions of the result folder");
}

Result<> write_file(const fs::path& path, std::string_view content) {
  return detail::write_whole(path, [&](const fs::path& temporary) -> Result<> {
    std::FILE* stream = std::fopen(temporary.c_str(), "wb");
    if (stream == nullptr) return write_error(path, system_reason());
    if (std::fwrite(content.data(), 1, content.size(), stream) != content.size()) {
      const std::string reason = system_reason();
      std::fclose(stream);
      return write_error(path, reason);
    }
    if (std::fclose(stream) != 0) return write_error(path, system_reason());
    return Ok{};
  });
}

Result<> prepare_folder(const fs::path& folder) {
  const auto refuse = [&](const std::string& reason) {
    return input_error("result folder " + folder.string(), reason,
                       "Choose another folder with -o, or change its permissions");
  };
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return refuse("cannot be created: " + code.message());
  if (!fs::is_directory(folder, code)) return refuse("exists and is not a folder");
  std::string probe = (folder / ".stylet-XXXXXX").string();
  const int descriptor = mkstemp(probe.data());
  if (descriptor < 0) return refuse("cannot be written to: " + system_reason());
  std::FILE* stream = fdopen(descriptor, "wb");
  if (stream != nullptr) std::fclose(stream);
  fs::remove(probe, code);
  return Ok{};
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

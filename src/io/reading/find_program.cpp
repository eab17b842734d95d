// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/find_program.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "stylet-reader";
constexpr const char* kVariable = "STYLET_READER";

/// Folders of the running program, and of the library that holds this function.
std::array<fs::path, 2> own_folders() {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  Dl_info library{};
  const bool known = ::dladdr(reinterpret_cast<const void*>(&find_reading_program), &library) != 0;
  const fs::path object = known && library.dli_fname != nullptr ? fs::canonical(library.dli_fname, code) : fs::path();
  return {program.parent_path(), object.parent_path()};
}

bool can_run(const fs::path& program) {
  std::error_code code;
  return fs::is_regular_file(program, code) && ::access(program.c_str(), X_OK) == 0;
}

}  // namespace

Result<fs::path> find_reading_program() {
  if (const char* named = std::getenv(kVariable); named != nullptr && *named != '\0') {
    if (can_run(named)) return fs::path(named);
    return failure(named, fmt::format("{} names this as the program that reads files, and it cannot be run", kVariable),
                   fmt::format("Set {} to a {}, or remove it from the environment", kVariable, kName));
  }
  const fs::path installed = fs::path("libexec") / "stylet" / kName;
  for (const fs::path& folder : own_folders()) {
    if (folder.empty()) continue;
    // Beside the program in a build folder; below bin, lib or lib/x86_64-linux-gnu of an installation.
    for (const fs::path& place : {folder / kName, folder / ".." / installed, folder / ".." / ".." / installed})
      if (can_run(place)) return place;
  }
  if (const fs::path configured = fs::path(STYLET_LIBEXEC) / "stylet" / kName; can_run(configured)) return configured;
  return failure(kName, "the program that reads files is neither beside this program nor installed",
                 fmt::format("Install it, or set {} to where it is", kVariable));
}

}  // namespace stylet::detail

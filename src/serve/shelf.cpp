// SPDX-License-Identifier: GPL-3.0-or-later
#include "shelf.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <set>
#include <string_view>

namespace stylet::serve {
namespace fs = std::filesystem;

namespace {

/// Keeps the letters, digits and dots of a name and replaces each run of other characters by a dash.
std::string tame(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
    if (plain || (!out.empty() && out.back() != '-')) out += plain ? c : '-';
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

}  // namespace

std::string Shelf::new_name(const std::string& of) const {
  const std::string base = fmt::format("{:%Y-%m-%d-%H%M%S}-{}", fmt::localtime(std::time(nullptr)), tame(of));
  std::string name = base;
  for (int k = 2; fs::exists(folder(name)); ++k) name = fmt::format("{}-{}", base, k);
  return name;
}

bool Shelf::is_own_name(const std::string& name) {
  constexpr std::string_view pattern = "0000-00-00-000000-";
  if (name.size() < pattern.size()) return false;
  return std::equal(pattern.begin(), pattern.end(), name.begin(),
                    [](char p, char c) { return p == '0' ? c >= '0' && c <= '9' : c == p; });
}

fs::path Shelf::folder(const std::string& name) const {
  std::error_code code;
  const bool archived = !archive_.empty() && !fs::exists(folder_ / name, code) && fs::exists(archive_ / name, code);
  return (archived ? archive_ : folder_) / name;
}

std::vector<std::string> Shelf::names() const {
  std::set<std::string, std::greater<>> names;
  for (const fs::path& folder : {folder_, archive_}) {
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
      std::error_code none;
      if (fs::is_regular_file(entry->path() / "run.h5", none)) names.insert(entry->path().filename().string());
    }
  }
  return {names.begin(), names.end()};
}

Result<RunRecording> Shelf::read(const std::string& name) const {
  const auto all = names();
  if (std::find(all.begin(), all.end(), name) == all.end())
    return input_error(fmt::format("recording '{}'", name),
                       fmt::format("there is no such recording in {}", folder_.string()),
                       "Choose one from the list of recordings");
  return read_recording(folder(name) / "run.h5");
}

std::vector<Result<RecordingHead>> Shelf::heads(std::span<const std::string> names) const {
  std::vector<fs::path> files;
  for (const std::string& name : names) files.push_back(folder(name) / "run.h5");
  return read_recording_heads(files);
}

}  // namespace stylet::serve

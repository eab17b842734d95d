// SPDX-License-Identifier: GPL-3.0-or-later
#include "shelf.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <map>
#include <string_view>
#include <tuple>

namespace stylet::serve {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kMoment = "0000-00-00-000000-";  ///< beginning of an own name, with digits for zeros

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
  if (name.size() < kMoment.size()) return false;
  return std::equal(kMoment.begin(), kMoment.end(), name.begin(),
                    [](char p, char c) { return p == '0' ? c >= '0' && c <= '9' : c == p; });
}

fs::path Shelf::folder(const std::string& name) const {
  std::error_code code;
  const bool archived = !archive_.empty() && !fs::exists(folder_ / name, code) && fs::exists(archive_ / name, code);
  return (archived ? archive_ : folder_) / name;
}

std::vector<std::string> Shelf::names() const {
  std::map<std::string, fs::file_time_type> begun;  // when run.h5 came into its folder
  for (const fs::path& folder : {folder_, archive_}) {
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
      std::error_code none;
      if (fs::is_regular_file(entry->path() / "run.h5", none))
        begun.emplace(entry->path().filename().string(), fs::last_write_time(entry->path(), none));
    }
  }
  std::vector<std::string> names;
  for (const auto& [name, time] : begun) names.push_back(name);
  // Names have seconds, in which a needle may follow another one.
  std::ranges::sort(names, std::greater<>(), [&](const std::string& name) {
    return std::tuple(is_own_name(name) ? name.substr(0, kMoment.size()) : name, begun.at(name), name);
  });
  return names;
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

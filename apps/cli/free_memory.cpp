// SPDX-License-Identifier: GPL-3.0-or-later
#include "free_memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace stylet::cli {

namespace {

namespace fs = std::filesystem;

/// The number that follows a name in a file of lines "name: number kB" [GB].
std::optional<double> gigabytes_of(const fs::path& file, const std::string& name) {
  std::ifstream lines(file);
  for (std::string word; lines >> word;) {
    double kilobytes = 0.0;
    if (word == name && lines >> kilobytes) return kilobytes * 1.024e-6;
  }
  return {};
}

/// The number that is alone in a file [bytes]; empty for "max".
std::optional<double> number_in(const fs::path& file) {
  double number = 0.0;
  if (std::ifstream(file) >> number) return number;
  return {};
}

}  // namespace

std::optional<double> free_memory_GB() {
  std::optional<double> least = gigabytes_of("/proc/meminfo", "MemAvailable:");
  const auto also = [&](double free_GB) { least = std::max(0.0, std::min(least.value_or(free_GB), free_GB)); };

  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    also(1e-9 * static_cast<double>(space.rlim_cur) - gigabytes_of("/proc/self/status", "VmSize:").value_or(0.0));

  // A line "0::/path" names the control group; each of its ancestors may have a limit as well.
  const fs::path root = "/sys/fs/cgroup";
  std::ifstream lines("/proc/self/cgroup");
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("0::/")) continue;
    for (fs::path group = root / line.substr(4);; group = group.parent_path()) {
      const auto most = number_in(group / "memory.max");
      const auto now = number_in(group / "memory.current");
      if (most && now) also(1e-9 * (*most - *now));
      if (group == root || !group.has_relative_path()) break;
    }
  }
  return least;
}

}  // namespace stylet::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/dose_input.hpp"

#include "model/digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <system_error>

namespace stylet {
namespace fs = std::filesystem;

namespace {

/// Empty: the file cannot be read.
std::string sha256_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  detail::Digest digest;
  std::array<char, 65536> part{};
  while (file.read(part.data(), part.size()) || file.gcount() > 0)
    digest.add_plain(part.data(), static_cast<std::size_t>(file.gcount()));
  return file.bad() ? std::string() : digest.finish();
}

std::string sha256_of_folder(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    if (at->is_regular_file(code)) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  detail::Digest digest;
  for (const fs::path& file : files) {
    const std::string line = sha256_of_file(file) + "  " + file.lexically_relative(folder).generic_string() + "\n";
    digest.add_plain(line.data(), line.size());
  }
  return code || files.empty() ? std::string() : digest.finish();
}

}  // namespace

DoseInput dose_input(const std::string& role, const fs::path& path) {
  std::error_code code;
  const bool folder = fs::is_directory(path, code);
  return {.role = role, .path = path.string(), .sha256 = folder ? sha256_of_folder(path) : sha256_of_file(path)};
}

std::vector<DoseInput> dose_inputs(const std::vector<std::pair<std::string, std::string>>& files) {
  std::vector<DoseInput> inputs;
  std::error_code code;
  for (const auto& [role, path] : files)
    if (!path.empty() && fs::exists(path, code)) inputs.push_back(dose_input(role, path));
  return inputs;
}

std::string date_and_time() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  if (::localtime_r(&now, &local) == nullptr) return {};
  const long minutes = std::labs(local.tm_gmtoff) / 60;
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02} {}{:02}:{:02}", local.tm_year + 1900, local.tm_mon + 1,
                     local.tm_mday, local.tm_hour, local.tm_min, local.tm_gmtoff < 0 ? '-' : '+', minutes / 60,
                     minutes % 60);
}

}  // namespace stylet

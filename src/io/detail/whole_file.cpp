// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/whole_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>

namespace stylet::detail {

namespace fs = std::filesystem;

Result<> write_whole(const fs::path& path, const std::function<Result<>(const fs::path&)>& write) {
  static std::atomic<unsigned> serial{0};  // makes names unique, since several threads may write at the same time
  std::error_code code;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) {
    return failure(path.string(), fmt::format("the folder '{}' does not exist", folder.string()),
                   "Create it or choose another place");
  }
  if (fs::is_directory(path, code)) {
    return failure(path.string(), "a folder of this name is in the way", "Choose another file name");
  }
  // The extension stays at the end, since some writers choose the format by it.
  const fs::path temporary =
      folder / fmt::format(".{}.{}-{}.part{}", path.stem().string(), ::getpid(), serial++, path.extension().string());
  Result<> written = write(temporary);
  if (!written) {
    fs::remove(temporary, code);
    return written;
  }
  fs::rename(temporary, path, code);
  if (code) {
    const std::string why = code.message();
    fs::remove(temporary, code);
    return failure(path.string(), "the file cannot be renamed to its final name: " + why,
                   "Check the folder's permissions and space");
  }
  return Ok{};
}

}  // namespace stylet::detail

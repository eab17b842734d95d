// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/private_files.hpp"

#include <sys/stat.h>

#include <system_error>

namespace stylet::detail {
namespace fs = std::filesystem;

void make_private_folder(const fs::path& folder) {
  std::error_code code;
  const fs::path place = folder.has_filename() ? folder : folder.parent_path();  // "live/" and "live" are the same
  fs::create_directories(place.parent_path(), code);
  if (::mkdir(place.c_str(), S_IRWXU) != 0) return;
  fs::permissions(place, fs::perms::owner_all, code);
}

void make_private(const fs::path& file) {
  std::error_code code;
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write, code);
}

}  // namespace stylet::detail

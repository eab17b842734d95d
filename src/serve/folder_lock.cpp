// SPDX-License-Identifier: GPL-3.0-or-later
#include "folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace stylet::serve {

FolderLock::FolderLock(const std::filesystem::path& folder, Kind kind)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW)) {
  if (folder_ < 0) return;
  const int what = (kind == Kind::alone ? LOCK_EX : LOCK_SH) | LOCK_NB;
  if (::flock(folder_, what) != 0) ::close(std::exchange(folder_, -1));
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) ::close(folder_);
}

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/disk.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace stylet::detail {

namespace fs = std::filesystem;

bool means_full(int reason) { return reason == ENOSPC || reason == EDQUOT; }

Error write_error(const fs::path& path, int reason, std::uintmax_t bytes) {
  if (means_full(reason)) {
    const std::string size = bytes == 0 ? "" : fmt::format(" (needs {:.2g} MB)", 1e-6 * static_cast<double>(bytes));
    return failure(path.string(), "no space is left on the disk" + size, "Free some, or choose another folder");
  }
  return failure(path.string(), fmt::format("cannot be written: {}", std::strerror(reason)),
                 "Check the disk and the permissions, or choose another folder");
}

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

int sync(int descriptor) {
  if (::fsync(descriptor) == 0) return 0;
  return errno == EINVAL || errno == EROFS || errno == ENOSYS ? 0 : errno;
}

Result<> sync(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0 && errno == EACCES) return Ok{};  // a folder into which one may write but not look
  const int reason = descriptor < 0 ? errno : sync(descriptor);
  if (descriptor >= 0) ::close(descriptor);
  if (reason == 0) return Ok{};
  return write_error(path, reason);
}

}  // namespace stylet::detail

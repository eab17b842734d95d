// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <utility>

namespace stylet::serve {

/// Says to all processes of this machine that a recording's folder is in use, for as long as it lives or its process
/// does. Many may use a folder at once; who wants to remove it must have it alone.
class FolderLock {
 public:
  enum class Kind { shared, alone };
  FolderLock() = default;
  /// Does not wait: see is_held().
  FolderLock(const std::filesystem::path& folder, Kind kind);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : folder_(std::exchange(other.folder_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(folder_, other.folder_);
    return *this;
  }

  /// False: somebody else's lock is in the way, or the folder or its file system cannot be locked.
  [[nodiscard]] bool is_held() const { return folder_ >= 0; }

 private:
  int folder_ = -1;  ///< descriptor
};

}  // namespace stylet::serve

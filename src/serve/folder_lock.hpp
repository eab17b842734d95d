// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <utility>

namespace stylet::serve {

/// A lock that tells all processes of this machine that a recording's folder is in use. It is released by its
/// destructor or when its process ends. Several users share a folder with Kind::shared; removing the folder needs
/// Kind::alone.
class FolderLock {
 public:
  enum class Kind { shared, alone };
  FolderLock() = default;
  /// Tries to lock, without waiting; is_held() tells whether it succeeded.
  FolderLock(const std::filesystem::path& folder, Kind kind);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : folder_(std::exchange(other.folder_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(folder_, other.folder_);
    return *this;
  }

  /// False: another lock excludes this one, or the folder or its file system cannot be locked.
  [[nodiscard]] bool is_held() const { return folder_ >= 0; }

 private:
  int folder_ = -1;  ///< descriptor
};

}  // namespace stylet::serve

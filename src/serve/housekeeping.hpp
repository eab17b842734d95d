// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace stylet::serve {

/// Limits of the disk space for recordings.
struct RecordingRoom {
  static constexpr std::uintmax_t kGigabyte = 1'000'000'000;
  std::uintmax_t most_bytes = 5 * kGigabyte;  ///< limit of all recordings together; 0: no limit
  std::uintmax_t low_bytes = kGigabyte;       ///< with less free disk space than this, users are warned
  std::uintmax_t full_bytes = kGigabyte / 5;  ///< with less, recording stops so that other programs can still write
};

/// Result of make_room(), in words; everything is empty if there is enough space.
struct RoomReport {
  std::string warning;               ///< a warning; recording continues
  std::string stop;                  ///< why recording must stop
  std::vector<std::string> removed;  ///< names of the recordings that were removed
};

/// Free bytes of the disk that holds a folder; the largest number if the system does not tell.
std::uintmax_t free_bytes(const std::filesystem::path& folder);

/// Removes the oldest recordings until all together are within the limit. It removes only recordings of the live page
/// that still have their original name (Shelf::new_name), have no other file in their folder, and are not being written
/// or replayed (FolderLock). To keep a recording for good, rename it.
/// @param folder the folder with the recordings
/// @param free returns the free bytes of the disk, as free_bytes() does
RoomReport make_room(const std::filesystem::path& folder, const RecordingRoom& room,
                     const std::function<std::uintmax_t(const std::filesystem::path&)>& free = free_bytes);

}  // namespace stylet::serve

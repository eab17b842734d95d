// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace stylet::serve {

/// How much room recordings may take.
struct RecordingRoom {
  static constexpr std::uintmax_t kGigabyte = 1'000'000'000;
  std::uintmax_t most_bytes = 5 * kGigabyte;  ///< all recordings together; 0: no limit
  std::uintmax_t low_bytes = kGigabyte;       ///< less than this free on the disk: people are warned
  std::uintmax_t full_bytes = kGigabyte / 5;  ///< less than this: nothing is recorded, so that others can go on writing
};

/// What a look at the recordings has found, in words; empty where all is well.
struct RoomReport {
  std::string warning;               ///< recording goes on
  std::string stop;                  ///< why it cannot
  std::vector<std::string> removed;  ///< recordings that had to go
};

/// Free bytes of the disk that a folder is on.
std::uintmax_t free_bytes(const std::filesystem::path& folder);

/// Keeps recordings within their room: the oldest ones go first. Only what the live page recorded is ever removed,
/// under the name that it gave (Shelf::new_name) and with nothing else in its folder, and nothing that anybody is
/// writing or replaying (FolderLock). So a recording that is to stay is renamed.
/// @param folder with the recordings
/// @param free as free_bytes()
RoomReport make_room(const std::filesystem::path& folder, const RecordingRoom& room,
                     const std::function<std::uintmax_t(const std::filesystem::path&)>& free = free_bytes);

}  // namespace stylet::serve

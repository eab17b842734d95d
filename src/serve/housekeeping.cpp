// SPDX-License-Identifier: GPL-3.0-or-later
#include "housekeeping.hpp"

#include "folder_lock.hpp"
#include "io/detail/unfinished.hpp"
#include "shelf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <system_error>

namespace stylet::serve {
namespace fs = std::filesystem;

namespace {

struct Recording {
  fs::path folder;
  fs::file_time_type last_written;
  std::uintmax_t bytes = 0;
};

bool holds_only_its_recording(const fs::path& folder) {
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    if (entry->path().filename() != "run.h5") return false;
  }
  return !code;
}

bool holds_only_unfinished_files(const fs::path& folder) {
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    if (!detail::is_unfinished(entry->path())) return false;
  }
  return !code;
}

/// The recordings that the live page made, oldest first.
std::vector<Recording> recordings_in(const fs::path& folder) {
  std::vector<Recording> found;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const fs::path& of = entry->path();
    std::error_code none;
    if (!entry->is_directory(none) || entry->is_symlink(none) || !Shelf::is_own_name(of.filename().string())) continue;
    Recording recording{of, fs::last_write_time(of / "run.h5", none), fs::file_size(of / "run.h5", none)};
    if (!none && holds_only_its_recording(of)) found.push_back(std::move(recording));
  }
  std::sort(found.begin(), found.end(), [](const Recording& a, const Recording& b) {
    return std::pair(a.last_written, a.folder) < std::pair(b.last_written, b.folder);
  });
  return found;
}

bool remove_unless_in_use(const Recording& recording) {
  const FolderLock lock(recording.folder, FolderLock::Kind::alone);
  if (!lock.is_held()) return false;
  std::error_code code;
  fs::remove_all(recording.folder, code);
  return !code;
}

/// Removes the folders of recordings that were not begun because their process was killed. A new folder is none of
/// them: its process may be about to lock it.
void remove_not_begun(const fs::path& folder) {
  constexpr std::chrono::minutes new_for{1};
  std::vector<fs::path> found;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const fs::path& of = entry->path();
    std::error_code none;
    if (!entry->is_directory(none) || entry->is_symlink(none) || !Shelf::is_own_name(of.filename().string())) continue;
    const bool is_old = fs::last_write_time(of, none) < fs::file_time_type::clock::now() - new_for;
    if (!none && is_old && holds_only_unfinished_files(of)) found.push_back(of);
  }
  for (const fs::path& of : found) (void)remove_unless_in_use({of, {}, 0});
}

std::string gigabytes(std::uintmax_t bytes) {
  return fmt::format("{:.3g} GB", static_cast<double>(bytes) / static_cast<double>(RecordingRoom::kGigabyte));
}

}  // namespace

std::uintmax_t free_bytes(const fs::path& folder) {
  std::error_code code;
  const fs::space_info space = fs::space(folder, code);
  return code ? std::numeric_limits<std::uintmax_t>::max() : space.available;  // a full disk shows when writing fails
}

RoomReport make_room(const fs::path& folder, const RecordingRoom& room,
                     const std::function<std::uintmax_t(const fs::path&)>& free) {
  remove_not_begun(folder);
  RoomReport report;
  if (room.most_bytes > 0) {
    const std::vector<Recording> recordings = recordings_in(folder);
    std::uintmax_t bytes = 0;
    for (const Recording& recording : recordings) bytes += recording.bytes;
    for (const Recording& recording : recordings) {
      if (bytes <= room.most_bytes) break;
      if (!remove_unless_in_use(recording)) continue;
      bytes -= recording.bytes;
      report.removed.push_back(recording.folder.filename().string());
    }
    if (bytes > room.most_bytes)
      report.stop = fmt::format("the recordings in use take {}, and the limit for all recordings is {} (--keep)",
                                gigabytes(bytes), gigabytes(room.most_bytes));
  }
  const std::uintmax_t left = free(folder);
  if (left < room.full_bytes) {
    report.stop = fmt::format("the disk of {} is nearly full: {} are free", folder.string(), gigabytes(left));
  } else if (left < room.low_bytes) {
    report.warning = fmt::format("only {} are free on the disk of {}", gigabytes(left), folder.string());
  }
  return report;
}

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/unfinished.hpp"

#include "detail/disk.hpp"
#include "detail/remark.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kBefore = ".stylet-", kBehind = ".part";
constexpr std::uintmax_t kLarge = 10'000'000;  ///< bytes whose removal the user is told of

fs::path hidden_name(unsigned number) { return fmt::format("{}{}-{}{}", kBefore, ::getpid(), number, kBehind); }

bool is_hidden(std::string_view name) {
  if (name.size() < kBefore.size() + kBehind.size() || !name.starts_with(kBefore) || !name.ends_with(kBehind))
    return false;
  name.remove_prefix(kBefore.size());
  name.remove_suffix(kBehind.size());
  return name.find_first_not_of("0123456789-") == std::string_view::npos;
}

std::uintmax_t bytes_under(const fs::path& path) {
  std::error_code code;
  if (!fs::is_directory(path, code)) return fs::file_size(path, code);
  std::uintmax_t bytes = 0;
  for (fs::recursive_directory_iterator entry(path, code), end; !code && entry != end; entry.increment(code)) {
    std::error_code none;
    if (entry->is_regular_file(none)) bytes += entry->file_size(none);
  }
  return bytes;
}

/// Removes a file or folder that no process has locked. @return its size [bytes]
std::uintmax_t remove_unless_in_use(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return 0;
  std::uintmax_t bytes = 0;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
    bytes = bytes_under(path);
    std::error_code code;
    fs::remove_all(path, code);
    if (code) bytes = 0;
  }
  ::close(descriptor);
  return bytes;
}

/// Removes what killed processes have left in a folder, when this process first writes into it.
void remove_abandoned(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> done;
  std::error_code code;
  {
    const std::lock_guard lock(mutex);
    if (!done.insert(fs::absolute(folder, code)).second) return;
  }
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    if (is_unfinished(entry->path())) found.push_back(entry->path());
  }
  std::uintmax_t bytes = 0;
  for (const fs::path& path : found) bytes += remove_unless_in_use(path);
  if (bytes >= kLarge)
    remark(fmt::format("{}: {:.0f} MB of unfinished files of runs that were killed have been removed.", folder.string(),
                       1e-6 * static_cast<double>(bytes)));
}

fs::path folder_above(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

}  // namespace

bool is_unfinished(const fs::path& path) { return is_hidden(path.filename().string()); }

Unfinished::Unfinished(fs::path path, fs::path hidden, int descriptor)
    : path_(std::move(path)), hidden_(std::move(hidden)), descriptor_(descriptor) {}

Unfinished::Unfinished(Unfinished&& other) noexcept
    : path_(std::move(other.path_)),
      hidden_(std::exchange(other.hidden_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

Unfinished::~Unfinished() {
  std::error_code ignored;
  if (descriptor_ >= 0) ::close(descriptor_);
  if (hidden_.empty()) return;
  // A file is removed without opening anything, since that may be what has failed.
  if (::unlink(hidden_.c_str()) != 0) fs::remove_all(hidden_, ignored);
}

std::optional<Unfinished> Unfinished::create(const fs::path& path, Kind kind, int& reason) {
  const fs::path folder = folder_above(path);
  remove_abandoned(folder);
  static std::atomic<unsigned> number{0};
  while (true) {
    const fs::path hidden = folder / hidden_name(number++);
    int descriptor = -1;
    if (kind != Kind::folder) {
      descriptor =
          ::open(hidden.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kind == Kind::private_file ? 0600 : 0666);
    } else if (::mkdir(hidden.c_str(), 0777) == 0) {
      descriptor = ::open(hidden.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    }
    reason = descriptor < 0 ? errno : 0;
    if (reason == EEXIST) continue;
    if (reason != 0) return std::nullopt;
    Unfinished made(path, hidden, descriptor);
    if (kind == Kind::private_file) (void)::fchmod(descriptor, 0600);  // whatever the umask
    (void)::flock(descriptor, LOCK_EX);  // where nothing can be locked, nothing is taken for abandoned either
    std::error_code code;
    if (fs::exists(hidden, code)) return made;
    // Before it was locked, another process took it for abandoned.
  }
}

Result<Unfinished> Unfinished::create(const fs::path& path, Kind kind) {
  const fs::path folder = folder_above(path);
  std::error_code code;
  if (!fs::is_directory(folder, code))
    return failure(path.string(), fmt::format("the folder '{}' does not exist", folder.string()),
                   "Create it or choose another place");
  if (kind != Kind::folder && fs::is_directory(path, code))
    return failure(path.string(), "a folder of this name is in the way", "Choose another file name");
  int reason = 0;
  auto made = create(path, kind, reason);
  if (!made) return write_error(path, reason);
  return std::move(*made);
}

Result<> Unfinished::finish() {
  if (const int reason = sync(descriptor_); reason != 0) return write_error(path_, reason);
  std::error_code code;
  fs::rename(hidden_, path_, code);
  if (code) return write_error(path_, code.value());
  hidden_.clear();
  // All of it is on the disk and has its name; only a power cut right now could undo the name.
  if (const Result<> kept = sync(folder_above(path_)); !kept)
    remark(
        fmt::format("{} is complete, but the disk does not confirm its name ({}). Make sure that it is there after "
                    "a power cut.",
                    path_.string(), kept.error().what));
  return Ok{};
}

}  // namespace stylet::detail

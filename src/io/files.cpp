// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/files.hpp"

#include "detail/disk.hpp"
#include "detail/unfinished.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace stylet {

namespace fs = std::filesystem;
using detail::Unfinished;

Result<> make_folder(const fs::path& folder) {
  const fs::path place = folder.has_filename() ? folder : folder.parent_path();  // "out/" and "out" are the same
  std::error_code code;
  if (fs::is_directory(place, code)) return Ok{};
  const fs::path above = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (above != place) {
    if (const Result<> made = make_folder(above); !made)
      return Error{made.error().kind, place.string(), made.error().what, made.error().cure};
  }
  if (::mkdir(place.c_str(), 0777) == 0) return detail::sync(above);
  const int reason = errno;
  if (fs::is_directory(place, code)) return Ok{};
  if (detail::means_full(reason)) return detail::write_error(place, reason);
  return input_error(place.string(), fmt::format("the folder cannot be created: {}", std::strerror(reason)),
                     "Choose another place, or change the permissions");
}

Result<> check_writable(const fs::path& folder) {
  constexpr std::size_t some = 4096;
  int reason = 0;
  const auto probe = Unfinished::create(folder / "probe", Unfinished::Kind::file, reason);
  if (probe) reason = detail::write_all(probe->descriptor(), std::string(some, ' '));
  if (reason == 0) reason = detail::sync(probe->descriptor());
  if (reason == 0) return Ok{};
  if (detail::means_full(reason)) return detail::write_error(folder, reason);
  return input_error(folder.string(),
                     fmt::format("the folder '{}' is not writable ({})", folder.string(), std::strerror(reason)),
                     "Choose another place, or change the permissions");
}

Result<> write_whole_file(const fs::path& path, std::string_view content, FileReaders readers) {
  std::error_code code;
  const fs::file_status there = fs::status(path, code);
  if (fs::exists(there) && !fs::is_regular_file(there) && !fs::is_directory(there)) {  // must not be replaced
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    const int reason = descriptor < 0 ? errno : detail::write_all(descriptor, content);
    if (descriptor >= 0) ::close(descriptor);
    if (reason == 0) return Ok{};
    return detail::write_error(path, reason);
  }
  using Kind = Unfinished::Kind;
  auto file = Unfinished::create(path, readers == FileReaders::owner ? Kind::private_file : Kind::file);
  if (!file) return file.error();
  if (const int reason = detail::write_all(file->descriptor(), content); reason != 0)
    return detail::write_error(path, reason, content.size());
  return file->finish();
}

}  // namespace stylet

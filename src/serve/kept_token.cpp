// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_token.hpp"

#include "access.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <string_view>
#include <system_error>

namespace stylet::serve {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kDigits = 32;

/// A file descriptor, closed at the end.
class File {
 public:
  File(const fs::path& path, int flags) : file_(::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0600)) {}
  ~File() {
    if (file_ >= 0) ::close(file_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// Nobody but this user may read or write it.
  [[nodiscard]] bool is_private() const {
    struct stat about {};
    return ::fstat(file_, &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == ::geteuid() &&
           (about.st_mode & 077) == 0;
  }
  [[nodiscard]] std::string read() const {
    std::array<char, kDigits + 1> text{};
    const auto size = ::read(file_, text.data(), text.size());
    return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }
  [[nodiscard]] bool write(std::string_view text) const {
    return ::fchmod(file_, 0600) == 0 && ::write(file_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  }

 private:
  int file_;
};

std::string token_in(const fs::path& path) {
  const File file(path, O_RDONLY);
  if (!file.is_private()) return {};
  std::string token = file.read();
  const bool whole = token.size() == kDigits && token.find_first_not_of("0123456789abcdef") == std::string::npos;
  return whole ? token : std::string();
}

/// Stores the token in a temporary file and renames that, so that the file is never incomplete.
void keep(const std::string& token, const fs::path& path) {
  std::error_code code;
  fs::create_directories(path.parent_path(), code);
  const fs::path part = path.parent_path() / fmt::format(".{}.{}.part", path.filename().string(), ::getpid());
  if (File(part, O_WRONLY | O_CREAT | O_EXCL).write(token)) fs::rename(part, path, code);
  fs::remove(part, code);
}

}  // namespace

std::string kept_token(const fs::path& file) {
  if (file.empty()) return random_token();
  std::string token = token_in(file);
  if (token.empty()) {
    token = random_token();
    keep(token, file);
  }
  return token;
}

}  // namespace stylet::serve

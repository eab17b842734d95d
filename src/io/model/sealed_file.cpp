// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/sealed_file.hpp"

#include "model/digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <vector>

namespace stylet::detail {
namespace fs = std::filesystem;

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// The seal is a text of fixed length: mark, length of the index, digest.
constexpr std::string_view kMark = "\nstylet seal 1\n";
constexpr std::size_t kLength = 16;
constexpr std::size_t kDigest = 64;
constexpr std::size_t kSeal = kMark.size() + kLength + kDigest;
constexpr std::uint64_t kLongestIndex = 1 << 20;
constexpr std::uint64_t kPiece = 1 << 20;

File opened(const fs::path& path) {
  File file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw NotSealed(std::strerror(errno));
  return file;
}

void read_at(std::FILE* file, std::uint64_t at, std::uint64_t bytes, void* to) {
  if (::fseeko(file, static_cast<off_t>(at), SEEK_SET) != 0 || std::fread(to, 1, bytes, file) != bytes)
    throw NotSealed(std::ferror(file) != 0 ? "it cannot be read" : "it ends too early");
}

/// Digest of the first bytes of a file.
std::string digest_of(std::FILE* file, std::uint64_t bytes, const std::function<void(double)>& progress) {
  Digest digest;
  std::vector<char> piece(kPiece);
  for (std::uint64_t at = 0; at < bytes; at += kPiece) {
    const std::uint64_t count = std::min(kPiece, bytes - at);
    read_at(file, at, count, piece.data());
    digest.add_plain(piece.data(), count);
    if (progress) progress(static_cast<double>(at) / static_cast<double>(bytes));
  }
  return digest.finish();
}

std::uint64_t size_of(std::FILE* file) {
  if (::fseeko(file, 0, SEEK_END) != 0) throw NotSealed("it cannot be read");
  return static_cast<std::uint64_t>(::ftello(file));
}

/// The seal of a file; empty if it has none.
std::string seal_of(std::FILE* file) {
  const std::uint64_t size = size_of(file);
  if (size < kSeal) return {};
  std::string seal(kSeal, '\0');
  read_at(file, size - kSeal, kSeal, seal.data());
  return seal.starts_with(kMark) ? seal : std::string();
}

}  // namespace

void SealedFile::seal(const fs::path& path, const std::string& index) {
  const auto fail = [] { throw std::system_error(errno, std::generic_category()); };
  const File file(std::fopen(path.c_str(), "r+b"), std::fclose);
  if (!file) fail();
  const auto append = [&](std::string_view text) {
    if (::fseeko(file.get(), 0, SEEK_END) != 0 || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
        std::fflush(file.get()) != 0)
      fail();
  };
  append(index);
  append(fmt::format("{}{:0{}}", kMark, index.size(), kLength));
  append(digest_of(file.get(), size_of(file.get()), {}));
}

bool SealedFile::is_marked(const fs::path& path) {
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return false;
  try {
    return !seal_of(opened(path).get()).empty();
  } catch (const NotSealed&) {
    return false;
  }
}

SealedFile::SealedFile(const fs::path& path, const std::function<void(double)>& progress)
    : file_(opened(path).release()) {
  const std::string seal = seal_of(file_.get());
  if (seal.empty()) throw NotSealed("the seal at its end is missing");
  const std::uint64_t before = size_of(file_.get()) - kDigest;
  if (digest_of(file_.get(), before, progress) != seal.substr(kSeal - kDigest))
    throw NotSealed("its bytes have changed since it was written");
  std::uint64_t length = 0;
  const char* const digits = seal.data() + kMark.size();
  const auto [end, status] = std::from_chars(digits, digits + kLength, length);
  if (status != std::errc{} || end != digits + kLength || length > kLongestIndex ||
      length > before - kMark.size() - kLength)
    throw NotSealed("its seal is wrong");
  size_ = before - kMark.size() - kLength - length;
  index_.resize(length);
  read_at(file_.get(), size_, length, index_.data());
}

void SealedFile::read(std::uint64_t at, std::uint64_t bytes, void* to) const {
  if (at > size_ || bytes > size_ - at) throw NotSealed("its index points outside of it");
  if (bytes > 0) read_at(file_.get(), at, bytes, to);
}

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>

namespace stylet::detail {

/// Memory that a library fills through a C stream. So nothing but write_whole_file() meets a full disk: libraries hide
/// its reason, or do not notice it.
class MemoryStream {
 public:
  MemoryStream() : stream_(::open_memstream(&data_, &size_)) {
    if (stream_ == nullptr) throw std::bad_alloc();
  }
  ~MemoryStream() { std::free(data_); }
  MemoryStream(const MemoryStream&) = delete;
  MemoryStream& operator=(const MemoryStream&) = delete;

  /// To be closed by its user.
  [[nodiscard]] std::FILE* stream() const { return stream_; }
  /// The bytes that were written. To be called after the stream has been closed.
  [[nodiscard]] std::string bytes() const { return {data_, size_}; }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_ = nullptr;
};

}  // namespace stylet::detail

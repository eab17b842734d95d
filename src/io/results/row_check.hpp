// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>

namespace stylet::results {

/// CRC-32 of a sequence of bytes and numbers: the check of a row.
class RowCheck {
 public:
  RowCheck& bytes(const void* data, std::size_t size) {
    value_ = static_cast<std::uint32_t>(::crc32_z(value_, static_cast<const Bytef*>(data), size));
    return *this;
  }
  template <class... Number>
  RowCheck& numbers(const Number&... number) {
    (bytes(&number, sizeof number), ...);
    return *this;
  }
  [[nodiscard]] std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_ = 0;
};

}  // namespace stylet::results

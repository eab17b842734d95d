// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string>
#include <type_traits>

struct evp_md_ctx_st;

namespace stylet::detail {

/// SHA-256 of a sequence of numbers and texts, each with its length, or of plain bytes.
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  template <class T>
  void add(std::span<const T> values) {
    static_assert(std::is_arithmetic_v<T>);
    add_bytes(values.data(), values.size_bytes());
  }
  void add(const std::string& text) { add_bytes(text.data(), text.size()); }
  void add_bytes(const void* data, std::size_t bytes);
  void add_plain(const void* data, std::size_t bytes);  ///< adds bytes without their length

  /// The digest in hexadecimal; nothing can be added afterwards.
  [[nodiscard]] std::string finish();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

}  // namespace stylet::detail

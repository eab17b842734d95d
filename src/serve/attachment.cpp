// SPDX-License-Identifier: GPL-3.0-or-later
#include "attachment.hpp"

#include <fmt/format.h>

#include <charconv>

namespace stylet::serve {

namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_';
}

}  // namespace

std::string attachment(std::string_view name) {
  std::string plain;
  std::string encoded;
  for (const char c : name) {
    plain += is_plain(c) || c == ' ' ? c : '_';
    encoded += is_plain(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return fmt::format("attachment; filename=\"{}\"; filename*=UTF-8''{}", plain, encoded);
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '%') {
      out += text[k];
      continue;
    }
    const std::string_view digits = text.substr(k + 1, 2);
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc{} || digits.size() != 2 || end != digits.data() + 2) return std::nullopt;
    out += static_cast<char>(value);
    k += 2;
  }
  return out;
}

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/text.hpp"

#include "stylet/core/printable.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace stylet::results {

std::string html_escaped(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : printable_lines(text)) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string html_prose(std::string_view text) {
  constexpr std::array<std::string_view, 6> kUnits{"mm", "N", "s", "µs", "%", "kHz"};
  const std::string plain = html_escaped(with_minus_signs(text));
  const auto is_letter = [&](std::size_t at) {
    return at < plain.size() && std::isalnum(static_cast<unsigned char>(plain[at])) != 0;
  };
  std::string html;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    const bool after_digit = k > 0 && std::isdigit(static_cast<unsigned char>(plain[k - 1])) != 0;
    const auto unit_follows = [&](std::string_view unit) {
      return plain.compare(k + 1, unit.size(), unit) == 0 && !is_letter(k + 1 + unit.size());
    };
    const bool keep = plain[k] == ' ' && after_digit && std::any_of(kUnits.begin(), kUnits.end(), unit_follows);
    html += keep ? "&nbsp;" : std::string(1, plain[k]);
  }
  return html;
}

std::string with_minus_signs(std::string_view text) {
  const auto is = [&](std::size_t at, auto kind) {
    return at < text.size() && kind(static_cast<unsigned char>(text[at])) != 0;
  };
  std::string with;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool number = is(k + 1, [](int c) { return std::isdigit(c); });
    const bool within =
        k > 0 && is(k - 1, [](int c) { return std::isalnum(c) + (c == '-') + (c == '_') + (c >= 0x80); });
    with += text[k] == '-' && number && !within ? "−" : std::string(1, text[k]);
  }
  return with;
}

std::string script_safe(std::string_view javascript) {
  const auto starts_with = [&](std::size_t at, std::string_view word) {
    if (javascript.size() - at < word.size()) return false;
    for (std::size_t k = 0; k < word.size(); ++k) {
      if (std::tolower(static_cast<unsigned char>(javascript[at + k])) != word[k]) return false;
    }
    return true;
  };
  std::string safe;
  safe.reserve(javascript.size());
  for (std::size_t k = 0; k < javascript.size(); ++k) {
    safe += javascript[k];
    if (javascript[k] == '<' && (starts_with(k, "</script") || starts_with(k, "<!--"))) safe += '\\';
  }
  return safe;
}

std::string json_script_safe(std::string_view json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = bytes.size() - k;
    const auto byte = [&](std::size_t j) { return j < left ? std::to_integer<std::uint32_t>(bytes[k + j]) : 0U; };
    const std::uint32_t triple = byte(0) << 16U | byte(1) << 8U | byte(2);
    text += kDigits[triple >> 18U & 63U];
    text += kDigits[triple >> 12U & 63U];
    text += left > 1 ? kDigits[triple >> 6U & 63U] : '=';
    text += left > 2 ? kDigits[triple & 63U] : '=';
  }
  return text;
}

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/text.hpp"

#include <charconv>

namespace stylet::detail {

std::string trimmed(std::string_view text) {
  constexpr std::string_view blanks(" \t\r\n\0", 5);
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0;;) {
    const auto end = text.find(separator, start);
    if (end == std::string_view::npos) {
      parts.push_back(text.substr(start));
      return parts;
    }
    parts.push_back(text.substr(start, end - start));
    start = end + 1;
  }
}

std::optional<HeaderLine> next_header_line(std::istream& stream) {
  using Traits = std::istream::traits_type;
  std::streambuf& bytes = *stream.rdbuf();
  if (Traits::eq_int_type(bytes.sgetc(), Traits::eof())) return std::nullopt;
  HeaderLine line;
  for (;;) {
    const auto next = bytes.sgetc();
    if (Traits::eq_int_type(next, Traits::eof())) return line;
    const char c = Traits::to_char_type(next);
    if (c != '\n' && c != '\r' && line.text.size() == kLongestHeaderLine) {
      line.whole = false;
      return line;
    }
    bytes.sbumpc();
    if (c == '\n') return line;
    if (c == '\r') {
      line.lone_return = !Traits::eq_int_type(bytes.sgetc(), Traits::to_int_type('\n'));
      if (!line.lone_return) bytes.sbumpc();
      return line;
    }
    line.text += c;
  }
}

std::optional<double> to_number(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r' || text.back() == '\0')) {
    text.remove_suffix(1);
  }
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

}  // namespace stylet::detail

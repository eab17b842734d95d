// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenario/toml_precheck.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::detail {

namespace {

bool beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }
bool blank(char c) { return c == ' ' || c == '\t'; }
bool begins_name(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '"' || c == '\'';
}

/// Number of bytes of the UTF-8 character that begins with this byte; 0 if no character does.
std::size_t length_of(char first) {
  const auto byte = static_cast<unsigned char>(first);
  if (byte < 0x80) return 1;
  if (byte >= 0xC2 && byte < 0xE0) return 2;
  if (byte >= 0xE0 && byte < 0xF0) return 3;
  return byte >= 0xF0 && byte < 0xF5 ? 4 : 0;
}

/// The first character of a text; empty if it is not valid UTF-8.
std::string_view character(std::string_view text) {
  const std::string_view bytes = text.substr(0, length_of(text.front()));
  const bool whole = bytes.size() == length_of(text.front());
  const bool follows = std::all_of(bytes.begin() + (bytes.empty() ? 0 : 1), bytes.end(),
                                   [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; });
  return whole && follows ? bytes : std::string_view{};
}

/// Scans a document once. It only distinguishes quotes, comments, brackets and headers, and does not parse TOML.
class Scan {
 public:
  Scan(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  Result<> run() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    char previous = '\n';  // the last character other than a blank
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (blank(c)) continue;
      if (Result<> next = follow(c, previous); !next) return next;
      previous = c;
    }
    return Ok{};
  }

 private:
  [[nodiscard]] std::string where() const {
    const std::string_view before = text_.substr(0, at_);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const auto start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    const auto characters = std::count_if(before.begin() + static_cast<std::ptrdiff_t>(start), before.end(),
                                          [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    return fmt::format("{}, line {}, column {}", source_, line, characters + 1);
  }

  [[nodiscard]] Error stray_character() const {
    const std::string_view c = character(text_.substr(at_));
    if (c.empty())
      return input_error(where(), "this is not text in UTF-8", "Save the file as text in UTF-8, or name another file");
    if (c == "\u00A0")
      return input_error(where(), "there is a no-break space, which TOML does not allow", "Write a plain space");
    for (const std::string_view quote :
         {"\u201C", "\u201D", "\u201E", "\u2018", "\u2019", "\u201A", "\u00AB", "\u00BB"}) {
      if (c == quote)
        return input_error(where(), fmt::format("{} is not a quotation mark of TOML", c),
                           "Put texts in straight quotation marks: \"D4\"");
    }
    return input_error(where(), fmt::format("the character {} stands outside of quotation marks", c),
                       "Put names and texts with such characters in quotation marks");
  }

  Result<> follow(char c, char previous) {
    if (c == '\n') {
      in_header_ = false;
      return Ok{};
    }
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      return Ok{};
    }
    if ((c == '"' || c == '\'') && begins_value(previous)) return skip_quoted(c);
    if (beyond_ascii(c)) return stray_character();
    if (c == '[' && previous == '\n' && open_.empty()) return begin_header();
    if (in_header_) return Ok{};
    if (std::string_view("\"'[{").find(c) != std::string_view::npos && !begins_value(previous)) {
      return input_error(where(), fmt::format("there is {} in the middle of a value", c),
                         "Put the whole text in quotation marks");
    }
    return follow_bracket(c);
  }

  /// Whether a text, a list or a key in quotation marks may begin after this character.
  static bool begins_value(char previous) {
    return std::string_view("\n=[{,.").find(previous) != std::string_view::npos;
  }

  /// Skips from the opening quotation mark to the closing one, or to the end of the line if there is none.
  Result<> skip_quoted(char quote) {
    const std::string three(3, quote);
    const bool many_lines = text_.substr(at_).starts_with(three);
    for (at_ += many_lines ? 3 : 1; at_ < text_.size(); ++at_) {
      if (many_lines ? text_.substr(at_).starts_with(three) : text_[at_] == quote) {
        if (!many_lines) return Ok{};
        // The three closing quotation marks may follow up to two that belong to the text.
        at_ += 2;
        for (int own = 0; own < 2 && at_ + 1 < text_.size() && text_[at_ + 1] == quote; ++own) ++at_;
        return Ok{};
      }
      if (!many_lines && text_[at_] == '\n') {
        --at_;
        return Ok{};
      }
      if (quote == '"' && text_[at_] == '\\') {
        // In a text of several lines, blanks and line ends may follow the backslash before the text continues.
        const auto next = text_.find_first_not_of(many_lines ? " \t\r\n" : "", at_ + 1);
        if (next != std::string_view::npos && beyond_ascii(text_[next])) {
          return input_error(where(), "after this \\ there is a character beyond ASCII",
                             "Write \\\\ for a backslash, and the text on one line");
        }
        ++at_;
      }
    }
    return Ok{};
  }

  /// Checks that the brackets and braces of lists and inline tables are balanced.
  Result<> follow_bracket(char c) {
    if (c == '[' || c == '{') open_ += c;
    if (c != ']' && c != '}') return Ok{};
    if (open_.empty()) {
      return input_error(where(), fmt::format("{} closes nothing", c),
                         "Write lists as [1, 2, 3] and inline tables as { key = value }");
    }
    if (const char expected = open_.back() == '[' ? ']' : '}'; c != expected) {
      return input_error(where(), fmt::format("there is {} where {} is expected", c, expected),
                         "Write lists as [1, 2, 3] and inline tables as { key = value }");
    }
    open_.pop_back();
    return Ok{};
  }

  /// Checks that a table header is "[" or "[[" followed by a name.
  Result<> begin_header() {
    in_header_ = true;
    auto name = at_ + 1;
    if (name < text_.size() && text_[name] == '[') ++name;
    while (name < text_.size() && blank(text_[name])) ++name;
    if (name < text_.size() && (begins_name(text_[name]) || beyond_ascii(text_[name]))) return Ok{};
    return input_error(where(), "a table begins here without a name",
                       "Write a table as [mesh], an insertion as [[insertion]]");
  }

  std::string_view text_;
  const std::string& source_;
  std::size_t at_ = 0;
  std::string open_;  ///< open brackets and braces, the innermost last
  bool in_header_ = false;
};

}  // namespace

bool is_readable(std::string_view text) {
  while (!text.empty()) {
    const std::string_view c = character(text);
    const auto byte = static_cast<unsigned char>(text.front());
    if (c.empty() || (byte < 0x20 && byte != '\t') || byte == 0x7f) return false;
    text.remove_prefix(c.size());
  }
  return true;
}

Result<> precheck_toml(std::string_view text, const std::string& source) { return Scan(text, source).run(); }

}  // namespace stylet::detail

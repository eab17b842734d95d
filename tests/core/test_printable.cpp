// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/printable.hpp"

#include "stylet/core/result.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

using namespace stylet;
using namespace std::string_literals;

namespace {

/// The characters of a text, decoded without the library's own functions; empty if it is not UTF-8.
std::vector<std::uint32_t> characters_of(const std::string& text) {
  std::vector<std::uint32_t> all;
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[k])); };
    const std::uint32_t first = byte(at);
    const std::size_t more = first < 0x80 ? 0 : first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
    std::uint32_t value = more == 0 ? first : first & (0x3FU >> more);
    if ((first >= 0x80 && first < 0xC0) || at + more >= text.size()) return {};
    for (std::size_t k = 1; k <= more; ++k) {
      if ((byte(at + k) & 0xC0U) != 0x80U) return {};
      value = value << 6U | (byte(at + k) & 0x3FU);
    }
    constexpr std::uint32_t kLeast[]{0, 0x80, 0x800, 0x10000};
    if (value < kLeast[more] || value > 0x10FFFF || (value >= 0xD800 && value < 0xE000)) return {};
    all.push_back(value);
    at += more + 1;
  }
  return all;
}

bool is_harmful(std::uint32_t c) {
  const auto within = [c](std::uint32_t first, std::uint32_t last) { return c >= first && c <= last; };
  return c < 0x20 || within(0x7F, 0x9F) || c == 0x61C || within(0x200E, 0x200F) || within(0x2028, 0x202E) ||
         within(0x2066, 0x2069);
}

/// Random bytes with many beginnings of characters and of those that steer.
std::string random_text(std::mt19937& random) {
  const std::vector<std::string> parts{"\xE2\x80\xAE", "\xE2\x81\xA6", "\xD8\x9C",      "\xE2\x80\x8F",
                                       "\x1b[31m",     "\xC2\x9B",     "\xE2\x80",      "\xF0\x9F",
                                       "前立腺",       "\0"s,          "a 'b' \"c\" /", "\n\t\r",
                                       "\\u001b",      "\\\\",         "\x7f",          "\xED\xA0\x80"};
  std::string text;
  const std::size_t count = random() % 60;
  for (std::size_t k = 0; k < count; ++k)
    text += random() % 2 == 0 ? parts[random() % parts.size()] : std::string(1, static_cast<char>(random()));
  return text;
}

}  // namespace

TEST(Printable, control_characters_become_blanks_and_other_characters_stay) {
  EXPECT_EQ(printable("Pro\x1b[31mstate"), "Pro [31mstate");
  EXPECT_EQ(printable("a\0b\rc\nd\te\x7f"
                      "f"s),
            "a b c d e f");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "31m"),
            "a 31m");
  for (const std::string text : {"Prostata", "Harnröhre", "前立腺", "Простата", "a\u00a0b", "\U0001F600"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, bytes_that_are_not_utf8_are_replaced_one_by_one) {
  const std::string r = "\xEF\xBF\xBD";
  EXPECT_EQ(printable("Harnr\xf6hre"), "Harnr" + r + "hre");
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            r + "31m");
  EXPECT_EQ(printable("\xe5\x89"), r + r);
  EXPECT_EQ(printable("\xe0\x82\x9b"), r + r + r) << "a control character in an overlong form";
  EXPECT_EQ(printable("\xc1\x9b"), r + r);
  EXPECT_EQ(printable("\xed\xa0\x80"), r + r + r) << "half of a surrogate pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), r + r + r + r) << "beyond Unicode";
}

TEST(Printable, lines_keep_their_ends) {
  EXPECT_EQ(printable_lines("a\tb\nc\r\x1b"
                            "d\n"),
            "a\tb\nc  d\n");
  EXPECT_EQ(printable("a\nb"), "a b");
}

TEST(Printable, marks_that_turn_the_direction_of_writing_become_blanks) {
  for (const std::string mark :
       {"\u061C", "\u200E", "\u200F", "\u202A", "\u202E", "\u2066", "\u2069", "\u2028", "\u2029"})
    EXPECT_EQ(printable("a" + mark + "b"), "a b") << mark;
  for (const std::string text : {"a\u200Db", "a\u2027b", "a\u202Fb", "a\u2065b", "a\u206Ab", "\u061Bb"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, whatever_the_bytes_nothing_harmful_comes_out) {
  std::mt19937 random(1);
  for (int k = 0; k < 20'000; ++k) {
    const std::string text = random_text(random);
    const std::string line = printable(text);
    const auto shown = characters_of(line);
    ASSERT_TRUE(line.empty() || !shown.empty()) << "not UTF-8: " << testing::PrintToString(text);
    ASSERT_TRUE(std::none_of(shown.begin(), shown.end(), is_harmful)) << testing::PrintToString(text);
    ASSERT_EQ(printable(line), line);
    const auto lines = characters_of(printable_lines(text));
    ASSERT_TRUE(std::none_of(lines.begin(), lines.end(),
                             [](std::uint32_t c) { return is_harmful(c) && c != 0x0A && c != 0x09; }));
    ASSERT_EQ(std::count(lines.begin(), lines.end(), 0x0AU), std::count(text.begin(), text.end(), '\n'));
    const std::vector<std::uint32_t> plain = characters_of(text);
    if (std::none_of(plain.begin(), plain.end(), is_harmful) && !plain.empty()) ASSERT_EQ(line, text);
    ASSERT_LE(characters_of(shortened(line, 7)).size(), 7u);
    ASSERT_TRUE(line.starts_with(shortened(line, 7).substr(0, shortened(line, 7).rfind("…"))));
  }
}

TEST(Printable, a_long_text_is_cut_between_characters) {
  EXPECT_EQ(shortened("前立腺", 3), "前立腺");
  EXPECT_EQ(shortened("前立腺癌", 3), "前立…");
  EXPECT_EQ(shortened("abc", 1), "…");
  const std::string name(5000, 'x');
  EXPECT_EQ(printable_name(name).size(), 299 + std::string("…").size());
}

TEST(Printable, long_quotations_are_cut_and_paths_are_not) {
  const std::string longer(400, 'x'), path = "/" + std::string(200, 'a') + "/" + std::string(200, 'b');
  const std::string cut = std::string(299, 'x') + "…";
  EXPECT_EQ(with_short_quotes("ROI '" + longer + "' is 'small'"), "ROI '" + cut + "' is 'small'");
  EXPECT_EQ(with_short_quotes("(\"" + longer + "\"), 'b'"), "(\"" + cut + "\"), 'b'");
  EXPECT_EQ(with_short_quotes("'" + longer), "'" + cut);
  EXPECT_EQ(with_short_quotes("the folder '" + path + "' is full"), "the folder '" + path + "' is full");
  EXPECT_EQ(with_short_quotes("the patient's " + longer), "the patient's " + longer) << "an apostrophe quotes nothing";
  EXPECT_EQ(characters_of(printable_clause(std::string(9000, 'y'))).size(), kLongestClause);
}

TEST(Printable, the_message_of_an_error_is_one_line_of_clean_text) {
  const Error e = failure("a\nb\x1b", "c '" + std::string(400, 'x') + "'\u202E\xff", "d\0e"s);
  EXPECT_EQ(e.message(), "a b : c '" + std::string(299, 'x') + "…' \xEF\xBF\xBD. d e");
  const std::string path = "/" + std::string(400, 'a') + "/" + std::string(400, 'b') + ".json";
  EXPECT_EQ(failure(path, "it is gone", "Look").message(), path + ": it is gone. Look");
}

TEST(Printable, json_has_no_control_characters_in_its_strings_and_is_json_still) {
  EXPECT_EQ(printable_json(R"({"a": "x\u001b\\u\n\r\b\f\t\"\\"})"), R"({"a": "x \\u\n   \t\"\\"})");
  EXPECT_EQ(printable_json("[\n  \"a\u202Eb\x7f\"\n]"), "[\n  \"a b \"\n]");
}

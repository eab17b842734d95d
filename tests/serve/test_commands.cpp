// SPDX-License-Identifier: GPL-3.0-or-later
// The table of commands, and the texts that are made of it. With STYLET_UPDATE=1 in the environment, these tests write
// the texts instead of comparing them.
#include "commands.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace stylet::serve;

namespace {

const std::filesystem::path kSource = STYLET_SOURCE;
constexpr const char* kUpdate = "run test_serve with STYLET_UPDATE=1 to write it";

std::string text_in(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Compares a file with what it is to be, or writes it.
void expect_text(const std::filesystem::path& file, const std::string& text) {
  if (std::getenv("STYLET_UPDATE") != nullptr) std::ofstream(file) << text;
  EXPECT_EQ(text_in(file), text) << kUpdate;
}

std::string type_in_script(const Argument& argument) {
  if (!argument.values.empty()) return std::string(argument.values);
  return argument.type == Argument::Type::text ? "string" : "number";
}

std::string script() {
  std::string out =
      "// SPDX-License-Identifier: GPL-3.0-or-later\n"
      "// The test Commands.* writes this file from the table in src/serve/commands.cpp.\n\n"
      "/** A command to the server (docs/live_protocol.md). */\nexport type Command =";
  for (const CommandRow& row : commands()) {
    out += "\n  | { do: '" + std::string(row.word) + "'";
    for (const Argument& argument : row.arguments) {
      if (argument.type != Argument::Type::none)
        out += "; " + std::string(argument.name) + ": " + type_in_script(argument);
    }
    out += " }";
  }
  return out + ";\n";
}

/// The arguments of a command in words: "with `key` (text) and `value` (number)".
std::string arguments_in_words(const CommandRow& row) {
  std::string out;
  for (const Argument& argument : row.arguments) {
    if (argument.type == Argument::Type::none) continue;
    out += out.empty() ? " with `" : " and `";
    out += std::string(argument.name) + "` (";
    if (!argument.values.empty()) {
      out += "`" + std::string(argument.values) + "`)";
    } else {
      out += argument.type == Argument::Type::text ? "text" : "number";
      out += (argument.unit.empty() ? "" : ", " + std::string(argument.unit)) + ")";
    }
  }
  return out;
}

std::string wrapped(const std::string& text) {
  constexpr std::size_t kColumns = 120;
  std::istringstream words(text);
  std::string out, word;
  std::size_t column = 0;
  while (words >> word) {
    std::size_t width = 0;  // in characters
    for (const char c : word) width += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
    if (column > 0 && column + 1 + width > kColumns) {
      out += "\n ";
      column = 1;
    }
    if (column > 0) out += " ";
    out += word;
    column += width + (column > 0 ? 1 : 0);
  }
  return out + "\n";
}

std::string list_in_document() {
  std::string out;
  for (const CommandRow& row : commands()) {
    out += wrapped("- `" + std::string(row.word) + "`" + arguments_in_words(row) + ": " + std::string(row.meaning) +
                   (row.counts == While::live     ? " It counts while a needle is live."
                    : row.counts == While::replay ? " It counts during a replay."
                                                  : ""));
  }
  return out;
}

}  // namespace

TEST(Commands, are_in_the_order_of_their_kinds_and_each_word_is_there_once) {
  std::set<std::string_view> words;
  for (const CommandRow& row : commands()) {
    EXPECT_EQ(&row_of(row.what), &row);
    EXPECT_TRUE(words.insert(row.word).second) << row.word;
    EXPECT_FALSE(row.meaning.empty()) << row.word;
    EXPECT_TRUE(row.arguments[0].type != Argument::Type::none || row.arguments[1].type == Argument::Type::none);
  }
}

TEST(Commands, of_the_page_are_those_of_the_server) { expect_text(kSource / "web/live/src/commands.ts", script()); }

TEST(Commands, in_the_protocol_are_those_of_the_server) {
  const std::filesystem::path file = kSource / "docs/live_protocol.md";
  const std::string from = "<!-- the test Commands.* writes from here -->\n", to = "<!-- to here -->\n";
  const std::string page = text_in(file);
  const std::size_t begin = page.find(from), end = page.find(to);
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  expect_text(file, page.substr(0, begin) + from + list_in_document() + page.substr(end));
}

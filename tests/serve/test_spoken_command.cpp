// SPDX-License-Identifier: GPL-3.0-or-later
#include "spoken_command.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::serve;

namespace {

/// The command as JSON, or its error.
std::string understood(const std::string& text) {
  const Result<Command> command = spoken_command(text);
  if (!command) return command.error().what;
  std::string out(row_of(command->what).word);
  if (!command->text.empty()) out += " " + command->text;
  if (command->number != 0.0) out += " " + std::to_string(command->number);
  return out;
}

}  // namespace

TEST(SpokenCommand, is_the_json_of_a_page_or_its_words) {
  EXPECT_EQ(understood(R"({"do": "hole", "hole": "D4"})"), "hole D4");
  EXPECT_EQ(understood("hole D4"), "hole D4");
  EXPECT_EQ(understood("  Hole   E3.5 "), "hole E3.5");
  EXPECT_EQ(understood("start again"), "reset");
  EXPECT_EQ(understood("Start Again"), "reset");
  EXPECT_EQ(understood("reset"), "reset");
  EXPECT_EQ(understood("needle 3"), "needle 3.000000");
  EXPECT_EQ(understood("set probe.lift_mm 8"), "set probe.lift_mm 8.000000");
  EXPECT_EQ(understood("hole 7"), "hole 7") << "a hole is a text";
}

TEST(SpokenCommand, refuses_what_the_table_of_commands_does_not_have) {
  for (const char* text : {"", " ", "start", "start again now", "hole", "hole D4 D5", "needle", "needle three",
                           "needle 1e999", "needle nan", "needle {\"a\":1}", "again", "{", "{}", R"({"do": "hole"})",
                           R"({"do": "needle", "index": "3"})", "reset 1", "\xC3\x28"})
    EXPECT_EQ(understood(text), "it is no command") << text;
  for (const char* text : {"take", "release", "drawn", R"({"do": "take"})"})
    EXPECT_EQ(understood(text), "this command is for pages only") << text;
  const Error error = spoken_command(std::string(500, 'x')).error();
  EXPECT_LT(error.where.size(), 80U);
  EXPECT_NE(error.cure.find("hole HOLE, insertion INDEX"), std::string::npos) << error.cure;
  EXPECT_EQ(error.cure.find("release"), std::string::npos) << error.cure;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "spoken_command.hpp"

#include "wire.hpp"

#include "io/detail/json_text.hpp"
#include "io/record/json.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

namespace stylet::serve {

namespace {

std::string in_other_case(std::string text, int (*change)(int)) {
  std::ranges::transform(text, text.begin(), [&](unsigned char c) { return static_cast<char>(change(c)); });
  return text;
}

std::vector<std::string> split_words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// The JSON of a command in words. Empty: no such command, or too many words.
std::string json_of_words(std::vector<std::string> words) {
  if (words.empty()) return {};
  words.front() = in_other_case(words.front(), std::tolower);
  if (words.size() == 2 && words.front() == "start" && in_other_case(words[1], std::tolower) == "again")
    words = {"reset"};
  const auto row = std::ranges::find(commands(), words.front(), &CommandRow::word);
  if (row == commands().end()) return {};
  record::Json json{{"do", words.front()}};
  std::size_t used = 1;
  for (const Argument& argument : row->arguments) {
    if (argument.type == Argument::Type::none || used == words.size()) break;
    const std::string& word = words[used++];
    const auto number = detail::parse_json<record::Json>(word, "argument");
    json[std::string(argument.name)] = argument.type == Argument::Type::text || !number ? record::Json(word) : *number;
  }
  return used == words.size() ? record::compact(json) : std::string();
}

/// "hole HOLE, insertion INDEX, …"
std::string all_in_words() {
  std::string all;
  for (const CommandRow& row : commands()) {
    if (!row.needs_needle) continue;
    all += (all.empty() ? "" : ", ") + std::string(row.word);
    for (const Argument& argument : row.arguments) {
      if (argument.type == Argument::Type::none) break;
      all += " " + in_other_case(std::string(argument.name), std::toupper);
    }
  }
  return all;
}

}  // namespace

Result<Command> spoken_command(const std::string& text) {
  const std::vector<std::string> words = split_words(text);
  const bool is_json = !words.empty() && words.front().front() == '{';
  const auto command = wire::decode_command(is_json ? text : json_of_words(words));
  if (command && row_of(command->what).needs_needle) return *command;
  constexpr std::size_t most = 60;
  const std::string shown = text.size() > most ? text.substr(0, most) + "..." : text;
  return input_error("'" + shown + "'", command ? "this command is for pages only" : "it is no command",
                     "Send start again, or one of these with its values: " + all_in_words());
}

}  // namespace stylet::serve

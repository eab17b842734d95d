// SPDX-License-Identifier: GPL-3.0-or-later
#include "usage.hpp"

#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::cli {

namespace {

/// The command whose options were being parsed; the program itself if there was no command.
const CLI::App& active(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? program : *commands.front();
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(word, known);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

/// Explains the first word that the parser could not assign.
std::string explain_word(const CLI::App& program, const CLI::App& app, const std::vector<std::string>& words) {
  const auto option =
      std::find_if(words.begin(), words.end(), [](const auto& w) { return w.size() > 1 && w[0] == '-'; });
  if (option != words.end()) {
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("unknown option '{}'{}", name, did_you_mean(name, option_names(app)));
  }
  if (&app == &program) {
    return fmt::format("unknown command '{}'{}", words.front(), did_you_mean(words.front(), command_names(program)));
  }
  return fmt::format("'{}' is one argument too many", words.front());
}

}  // namespace

std::string explain(const CLI::ParseError& error, const CLI::App& program) {
  const CLI::App& app = active(program);
  const std::string name = &app == &program ? program.get_name() : program.get_name() + ' ' + app.get_name();
  // An unknown word is reported before a missing one, because the unknown word is often the missing one with a typing
  // error.
  const std::vector<std::string> words = program.remaining(true);
  std::string what;
  if (!words.empty()) {
    what = explain_word(program, app, words);
  } else if (&app == &program && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    what = fmt::format("no command given; the commands are {}", fmt::join(command_names(program), ", "));
  } else {
    what = error.what();
  }
  while (!what.empty() && (what.back() == '\n' || what.back() == '.')) what.pop_back();
  const bool done = !what.empty() && what.back() == '?';
  return fmt::format("{}{} See {} --help", what, done ? "" : ".", name);
}

}  // namespace stylet::cli

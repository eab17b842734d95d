// SPDX-License-Identifier: GPL-3.0-or-later
#include "usage.hpp"

#include "stylet/core/nearest_name.hpp"
#include "stylet/sim/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

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

/// For a command with --set: the key of the scenario that an unknown option may mean, "--nodes" for mesh.nodes.
std::string as_setting(const std::string& option, const CLI::App& app) {
  if (app.get_option_no_throw("--set") == nullptr) return {};
  std::vector<std::string> leaves;
  for (const ScenarioKey& key : scenario_keys()) leaves.push_back(key.path.substr(key.path.rfind('.') + 1));
  std::string wanted = option.substr(std::min(option.find_first_not_of('-'), option.size()));
  std::replace(wanted.begin(), wanted.end(), '-', '_');
  const std::string near = nearest_name(wanted, leaves);
  if (near.empty()) return {};
  const auto at = static_cast<std::size_t>(std::find(leaves.begin(), leaves.end(), near) - leaves.begin());
  std::string path = scenario_keys()[at].path;
  if (const auto list = path.find("[]"); list != std::string::npos) path.insert(list + 1, "0");
  if (const auto region = path.find("<region>"); region != std::string::npos) path.replace(region, 8, "REGION");
  return fmt::format("; a key of the scenario is set with --set {}=VALUE", path);
}

/// A word in the place of the command that is none.
std::string unknown(const std::string& word, const CLI::App& program) {
  std::error_code code;
  if (std::filesystem::exists(word, code)) {
    return fmt::format("'{}' is a file or folder; a command comes first, for example stylet info '{}'", word, word);
  }
  const std::vector<std::string> commands = command_names(program);
  std::string meant = did_you_mean(word, commands);
  if (meant.empty()) meant = fmt::format("; the commands are {}", fmt::join(commands, ", "));
  return fmt::format("unknown command '{}'{}", word, meant);
}

/// Explains the first word that the parser could not assign.
std::string explain_word(const CLI::App& program, const CLI::App& app, const std::vector<std::string>& words) {
  const auto option =
      std::find_if(words.begin(), words.end(), [](const auto& w) { return w.size() > 1 && w[0] == '-'; });
  if (option != words.end()) {
    const std::string name = option->substr(0, option->find('='));
    std::string meant = did_you_mean(name, option_names(app));
    if (meant.empty()) meant = as_setting(name, app);
    return fmt::format("unknown option '{}'{}", name, meant);
  }
  if (&app == &program) {
    return unknown(words.front(), program);
  }
  const CLI::Option* output = app.get_option_no_throw("--output");
  const bool is_output = output != nullptr && output->count() == 0;
  return fmt::format("'{}' is one argument too many{}", words.front(),
                     is_output ? fmt::format("; an output is given with -o {}", words.front()) : "");
}

/// A message of the parser about the value of an option in plainer words. Those of validators (validators.hpp) and
/// about options that are required or exclude each other stay.
std::string explain_value(const std::string& message) {
  constexpr std::string_view kNotConverted = "Could not convert: ";
  const auto equals = message.find(" = ");
  if (message.starts_with(kNotConverted) && equals != std::string::npos) {
    return fmt::format("'{}' is no value of {}", message.substr(equals + 3),
                       message.substr(kNotConverted.size(), equals - kNotConverted.size()));
  }
  const auto colon = message.find(": ");
  if (colon != std::string::npos && message.find(" required ") != std::string::npos)
    return fmt::format("{} lacks a value", message.substr(0, colon));
  return message;
}

}  // namespace

bool is_command(const std::string& word, const CLI::App& program) {
  const std::vector<std::string> names = command_names(program);
  return std::find(names.begin(), names.end(), word) != names.end();
}

std::string unknown_command(const std::vector<std::string>& words, const CLI::App& program) {
  std::string what = unknown(words.front(), program);
  if (words.size() > 1 && is_command(words[1], program)) {
    what = fmt::format("the command comes before its arguments: write stylet {} {} …", words[1], words.front());
  }
  return fmt::format("{}{} See stylet --help", what, what.back() == '?' ? "" : ".");
}

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
    what = explain_value(error.what());
  }
  while (!what.empty() && (what.back() == '\n' || what.back() == '.')) what.pop_back();
  const bool done = !what.empty() && what.back() == '?';
  return fmt::format("{}{} See {} --help", what, done ? "" : ".", name);
}

}  // namespace stylet::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace stylet::cli {

/// Explains an error of the command line: names the nearest known option or command for an unknown one, otherwise gives
/// the parser's message; refers to --help.
/// @param program the program after its parse() threw
std::string explain(const CLI::ParseError& error, const CLI::App& program);

/// Whether a word is the name of a command.
bool is_command(const std::string& word, const CLI::App& program);

/// Explains a command line that does not begin with a command: names the nearest command or all of them.
/// @param words the command line without the program; the first word is no command
std::string unknown_command(const std::vector<std::string>& words, const CLI::App& program);

}  // namespace stylet::cli

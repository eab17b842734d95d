// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace stylet::cli {

/// Explains an error of the command line: names the nearest known option or command for an unknown one, otherwise gives
/// the parser's message; refers to --help.
/// @param program the program after its parse() threw
std::string explain(const CLI::ParseError& error, const CLI::App& program);

}  // namespace stylet::cli

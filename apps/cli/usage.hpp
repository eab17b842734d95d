// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace stylet::cli {

/// One sentence on what is wrong with the command line: for an unknown option or command the nearest known one, else
/// the parser's own words, and where to read more.
/// @param program the program after its parse() threw
std::string explain(const CLI::ParseError& error, const CLI::App& program);

}  // namespace stylet::cli

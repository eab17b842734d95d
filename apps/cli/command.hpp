// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include <CLI/CLI.hpp>

#include <functional>

namespace stylet::cli {

/// A command of the program. `options` outlives the command line's reading because `run` holds it.
struct Command {
  CLI::App* app = nullptr;  ///< parses its options
  /// Does the work. An Error becomes a message and exit status 2 (input) or 1 (failed); must not throw on bad input.
  std::function<Result<>(Console&)> run;
};

/// Each adds its command to the program. To add one: a file command_NAME.cpp, a line here, a line in main.cpp.
Command add_phantom_command(CLI::App& program);
Command add_mesh_command(CLI::App& program);
Command add_info_command(CLI::App& program);
Command add_prepare_command(CLI::App& program);
Command add_insert_command(CLI::App& program);
Command add_reproduce_command(CLI::App& program);
Command add_bench_command(CLI::App& program);
Command add_validate_command(CLI::App& program);
Command add_serve_command(CLI::App& program);

}  // namespace stylet::cli

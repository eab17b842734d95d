// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include <CLI/CLI.hpp>

#include <functional>

namespace stylet::cli {

/// A command of the program. `run` owns the options that the command line sets, so that they exist when it is called.
struct Command {
  CLI::App* app = nullptr;  ///< parses the options of the command
  /// Does the work. An Error becomes a message and exit status 2 (input) or 1 (failed). Must not throw on bad input.
  std::function<Result<>(Console&)> run;
};

/// Each function adds its command to the program. To add a command, write a file command_NAME.cpp and add a line here
/// and in main.cpp.
Command add_phantom_command(CLI::App& program);
Command add_mesh_command(CLI::App& program);
Command add_info_command(CLI::App& program);
Command add_prepare_command(CLI::App& program);
Command add_insert_command(CLI::App& program);
Command add_reproduce_command(CLI::App& program);
Command add_bench_command(CLI::App& program);
Command add_validate_command(CLI::App& program);
Command add_dose_command(CLI::App& program);
Command add_implant_command(CLI::App& program);
Command add_fluoro_command(CLI::App& program);
Command add_image_command(CLI::App& program);
Command add_serve_command(CLI::App& program);

}  // namespace stylet::cli

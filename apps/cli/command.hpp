// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/core/need.hpp"

#include <CLI/CLI.hpp>

#include <functional>

namespace stylet::cli {

/// A command of the program. `run` owns the options that the command line sets, so that they exist when it is called.
struct Command {
  CLI::App* app = nullptr;  ///< parses the options of the command
  /// Does the work. An Error that it returns, or throws by need(), becomes a message and exit status 2 (input) or 1
  /// (failed). Throws nothing else on bad input.
  std::function<Result<>(Console&)> run;
};

/// Adds an option. @param type name of its value in the help, such as "FILE"
template <class T>
CLI::Option* option(CLI::App* app, const char* name, T& value, const char* type, const std::string& text) {
  return app->add_option(name, value, text)->type_name(type);
}

/// Adds an option that may be repeated, with one value each time.
inline CLI::Option* repeated_option(CLI::App* app, const char* name, std::vector<std::string>& values, const char* type,
                                    const std::string& text) {
  return option(app, name, values, type, text)->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// Adds --set, which sets keys of the scenario. @param example such as "mesh.nodes=5000"
inline CLI::Option* settings_option(CLI::App* app, std::vector<std::string>& settings, const std::string& example) {
  return repeated_option(app, "--set", settings, "KEY=VALUE",
                         "Set a key of the scenario, e.g. --set " + example + "; may be repeated");
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
// The stylet program: parses the command line, runs one command, and returns an exit status.
#include "command.hpp"
#include "standard_streams.hpp"
#include "threads.hpp"
#include "usage.hpp"
#include "validators.hpp"

#include "stylet/core/parallel.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

namespace {

using namespace stylet;
using namespace stylet::cli;

// Exit statuses; docs/command_line.md documents them.
constexpr int kOk = 0;
constexpr int kFailed = 1;
constexpr int kBadInput = 2;

void add_common_options(CLI::App& app, CommonOptions& common) {
  const std::string group = "Options of every command";
  option(&app, "--json", common.json, "FILE", "Write the result as JSON to this file; '-' for standard output")
      ->group(group);
  app.add_flag("--quiet", common.quiet, "Print warnings and errors only")->group(group);
  app.add_flag("--verbose", common.verbose, "Print more details of the work, and the processor time of its phases")
      ->group(group);
  option(&app, "--threads", common.threads, "N", "Use at most N threads (default: one per core)")
      ->check(whole_number_between(1, 1024))
      ->group(group);
}

int report(Console& console, const Error& error) {
  std::string message = error.message();
  if (!message.empty() && std::string_view(".?!").find(message.back()) == std::string_view::npos) message += '.';
  console.error(message);
  return error.kind == ErrorKind::input ? kBadInput : kFailed;
}

/// The words of the command line, with the ways to ask for help that other programs have: `help`, `help COMMAND` and
/// `version` become options.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) return words;
  if (words.front() == "version") words.front() = "--version";
  if (words.front() == "help") {
    words.erase(words.begin());
    if (words.empty()) return {"--help"};
    words.resize(1);
    words.emplace_back("--help");
  }
  return words;
}

int run(int argc, char** argv, Console& console) {
  CLI::App program("Real-time simulation of a flexible needle in soft tissue. Not a medical device.", "stylet");
  program.set_version_flag("--version", std::string("stylet ") + version());
  program.require_subcommand(1);
  program.footer("Exit status: 0 success, 1 the run failed, 2 the input or the command line was wrong.");

  CommonOptions common;
  const std::array commands{add_phantom_command(program), add_mesh_command(program),     add_info_command(program),
                            add_prepare_command(program), add_insert_command(program),   add_reproduce_command(program),
                            add_bench_command(program),   add_validate_command(program), add_serve_command(program),
                            add_dose_command(program),    add_implant_command(program),  add_image_command(program),
                            add_fluoro_command(program)};
  add_common_options(program, common);  // common options may stand before or after the command
  for (const Command& command : commands) add_common_options(*command.app, common);

  std::vector<std::string> words = words_of(argc, argv);
  if (!words.empty() && !words.front().starts_with('-') && !is_command(words.front(), program)) {
    console.error(unknown_command(words, program));
    return kBadInput;
  }
  std::reverse(words.begin(), words.end());  // the parser takes them from the back
  try {
    program.parse(std::move(words));
  } catch (const CLI::Success& asked) {  // --help, --version
    const int status = program.exit(asked);
    if (std::cout.flush()) return status;
    console.error("standard output: writing failed. Check the file or program that receives it.");
    return kFailed;
  } catch (const CLI::ParseError& error) {
    console.error(explain(error, program));
    return kBadInput;
  }

  if (common.threads > 0) {
    limit_threads(common.threads);
    set_worker_threads(common.threads);
  }
  if (const Result<> configured = console.configure(common); !configured) return report(console, configured.error());
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    try {
      const Result<> done = command.run(console);
      console.tell_phases();
      return done ? kOk : report(console, done.error());
    } catch (const Failed& failed) {
      return report(console, failed.error);
    }
  }
  return kBadInput;
}

int guarded_run(int argc, char** argv, Console& console) {
  try {
    return run(argc, argv, console);
  } catch (const std::bad_alloc&) {
    console.error("out of memory. Use a coarser mesh (--nodes) or a machine with more memory");
  } catch (const std::exception& unexpected) {
    console.detail(fmt::format("the fault says of itself: {}", unexpected.what()));
    console.error("unexpected failure. Please report it with the command line and the input");
  }
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Console console(prepare_standard_streams());
    receive_remarks([&console](const std::string& remark) { console.warn(remark); });
    return guarded_run(argc, argv, console);
  } catch (const std::bad_alloc&) {  // not even the console can be had
    std::fputs("stylet: error: out of memory. Use a machine with more memory.\n", stderr);
  }
  return kFailed;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <string_view>

namespace stylet::cli {

using Json = nlohmann::ordered_json;

/// Options that every command has.
struct CommonOptions {
  bool quiet = false;
  bool verbose = false;
  int threads = 0;   ///< largest number of threads of a library; 0: one per core
  std::string json;  ///< file for the result as JSON; "-": standard output; empty: none
};

/// All output to the user. Results go to standard output, everything else to standard error. With `--json -` standard
/// output carries only the JSON, even if a library prints something.
class Console {
 public:
  /// @param output_is_open whether the program was started with a standard output (standard_streams.hpp)
  explicit Console(bool output_is_open = true);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Applies the options. Called once, after the command line has been parsed.
  Result<> configure(const CommonOptions& options);

  /// Prints a result: one or more lines without the last line end. Prints nothing with --quiet.
  /// If standard output cannot be written (a full disk, a closed pipe), a warning is printed once and work continues.
  void say(std::string_view text);
  /// The same for a command whose only result is this text: an error if it cannot be printed.
  Result<> print(std::string_view text);
  /// Prints a detail on standard error; only with --verbose.
  void detail(std::string_view text);
  void warn(std::string_view text);
  /// Warns before the work whose own warnings will have the same text: warn() then leaves it out once.
  void warn_ahead(const std::string& text);
  void error(std::string_view text);

  /// Prints a sentence on standard error before the first progress that is shown: only work that takes longer than a
  /// moment needs it.
  void tell_with_progress(const std::string& text);
  /// Shows the progress of long work: a bar if standard error is a terminal, otherwise plain lines from time to time.
  /// Shows nothing in the first second and with --quiet. Ends when the last copy of the returned function is destroyed.
  [[nodiscard]] Progress progress();
  /// Prints the processor time of the phases that progress was reported of; only with --verbose.
  void tell_phases();

  /// Writes the result as JSON to the target of --json; does nothing without --json. A file appears complete or not at
  /// all.
  Result<> write_json(const Json& json);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::cli

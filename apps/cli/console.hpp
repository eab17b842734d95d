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

/// Options every command has.
struct CommonOptions {
  bool quiet = false;
  bool verbose = false;
  int threads = 0;   ///< most threads a library may use, 0 = one per core
  std::string json;  ///< file for the machine-readable result, "-" = standard output, empty = none
};

/// All talk with the user. Results go to standard output, everything else to standard error; with `--json -` standard
/// output carries the JSON and nothing else, whoever prints.
class Console {
 public:
  /// @param output_is_open whether the program was started with a standard output (standard_streams.hpp)
  explicit Console(bool output_is_open = true);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Takes the options into account; called once, after the command line has been read.
  Result<> configure(const CommonOptions& options);

  /// A result, one or more lines without the last line end. Nothing with --quiet.
  /// Where standard output takes no more (a full disk, a reader that has gone), that is said once on standard error,
  /// and the work goes on.
  void say(std::string_view text);
  /// For commands whose result is what they say: an error where some of it was lost.
  [[nodiscard]] Result<> said() const;
  /// Something only the curious want to know; only with --verbose.
  void detail(std::string_view text);
  void warn(std::string_view text);
  void error(std::string_view text);

  /// For long work: a bar when standard error is a terminal, now and then a plain line otherwise; nothing in the first
  /// second, nothing with --quiet. Shown until the last copy of the returned function is gone.
  [[nodiscard]] Progress progress();

  /// Writes the machine-readable result where --json says; does nothing without --json. A file appears whole or not at
  /// all.
  Result<> write_json(const Json& json);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::cli

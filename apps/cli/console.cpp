// SPDX-License-Identifier: GPL-3.0-or-later
#include "console.hpp"

#include "output_path.hpp"
#include "phase_times.hpp"
#include "progress_display.hpp"

#include "stylet/core/json_text.hpp"
#include "stylet/core/printable.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <utility>

namespace stylet::cli {

namespace {

/// Writes the whole text to a file descriptor. @return false with errno set if that fails
bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

bool stderr_is_terminal() {
  const char* term = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && term != nullptr && std::strcmp(term, "dumb") != 0;
}

}  // namespace

struct Console::Parts {
  CommonOptions options;
  bool output_is_open = true;
  bool output_is_lost = false;             ///< standard output could not be written
  int json_descriptor = -1;                ///< the real standard output while --json - redirects stdout to stderr
  std::mutex mutex;                        ///< guards the next member: stylet serve warns from several threads
  std::set<std::string> told;              ///< warnings that were given ahead
  std::string first_progress;              ///< a sentence to print before the first progress
  std::weak_ptr<ProgressDisplay> display;  ///< exists while progress may be reported
  std::shared_ptr<PhaseTimes> phases;      ///< with --verbose, once progress may have been reported

  /// Prints a line. Every text of the program passes here on its way to the terminal, so this is where control
  /// characters that a file has brought into it are replaced and long quoted texts cut. @return the reason if it could
  /// not be printed, otherwise empty
  std::string line(std::FILE* stream, std::string_view prefix, std::string_view text) const {
    const std::string all = fmt::format("{}{}\n", prefix, with_short_quotes(printable_lines(text)));
    std::string reason;
    const auto print = [&] {
      if (std::fwrite(all.data(), 1, all.size(), stream) == all.size() && std::fflush(stream) == 0) return;
      reason = std::strerror(errno);
      std::clearerr(stream);
    };
    if (const auto shown = display.lock()) {
      shown->interrupt(print);
    } else {
      print();
    }
    return reason;
  }
};

Console::Console(bool output_is_open) : parts_(std::make_unique<Parts>()) { parts_->output_is_open = output_is_open; }

Console::~Console() {
  if (parts_->json_descriptor >= 0) ::close(parts_->json_descriptor);
}

Result<> Console::configure(const CommonOptions& options) {
  parts_->options = options;
  if (options.json.empty()) return Ok{};
  if (options.json != "-") return check_output_file(options.json);
  // From here on, everything that this program or a library prints to standard output goes to standard error.
  std::fflush(stdout);
  if (parts_->output_is_open) parts_->json_descriptor = ::dup(STDOUT_FILENO);
  if (parts_->json_descriptor < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) {
    return failure("--json -", "standard output is closed", "Give a file name instead of '-'");
  }
  return Ok{};
}

void Console::say(std::string_view text) {
  if (parts_->output_is_lost) return;
  if (const Result<> done = print(text); !done) {
    parts_->output_is_lost = true;
    warn(done.error().message());
  }
}

Result<> Console::print(std::string_view text) {
  if (parts_->options.quiet) return Ok{};
  const std::string reason = parts_->line(stdout, "", text);
  if (reason.empty()) return Ok{};
  return failure("standard output", "writing failed: " + reason, "Check the file or program that receives it");
}

void Console::detail(std::string_view text) {
  if (parts_->options.verbose) parts_->line(stderr, "stylet: ", text);
}

void Console::tell_phases() {
  if (parts_->phases) detail(parts_->phases->table());
}

void Console::warn(std::string_view text) {
  {
    const std::lock_guard lock(parts_->mutex);
    if (parts_->told.erase(std::string(text)) > 0) return;
  }
  parts_->line(stderr, "stylet: warning: ", text);
}

void Console::warn_ahead(const std::string& text) {
  warn(text);
  const std::lock_guard lock(parts_->mutex);
  parts_->told.insert(text);
}

void Console::error(std::string_view text) { parts_->line(stderr, "stylet: error: ", text); }

void Console::tell_with_progress(const std::string& text) { parts_->first_progress = "stylet: " + text; }

Progress Console::progress() {
  if (parts_->options.quiet) return {};
  auto display = std::make_shared<ProgressDisplay>(stderr_is_terminal(), std::exchange(parts_->first_progress, {}));
  parts_->display = display;
  if (parts_->options.verbose && !parts_->phases) parts_->phases = std::make_shared<PhaseTimes>();
  return [display, phases = parts_->phases](std::string_view stage, double fraction) {
    if (phases) phases->enter(stage);
    display->update(stage, fraction);
  };
}

Result<> Console::write_json(const Json& json) {
  const std::string& target = parts_->options.json;
  if (target.empty()) return Ok{};
  const std::string text = json_text(json, 2) + '\n';
  if (target != "-") return write_text_file(target, text);
  if (!write_all(parts_->json_descriptor, text)) {
    return failure("--json -", std::string("writing to standard output failed: ") + std::strerror(errno),
                   "Check the file or program that receives it");
  }
  return Ok{};
}

}  // namespace stylet::cli

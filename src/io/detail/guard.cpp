// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/guard.hpp"

#include "detail/text.hpp"

#include <fmt/format.h>

#include <cstring>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

/// The last line a library printed, as a clause; empty when it kept silent.
std::string last_words(const std::string& noise) {
  std::string last;
  for (const auto line : split(noise, '\n')) {
    if (std::string words = trimmed(line); !words.empty()) last = std::move(words);
  }
  for (char& c : last) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return last.empty() ? "" : fmt::format("; its last words: {}", last.substr(0, 200));
}

}  // namespace

ChildLimits limits_for(const fs::path& path) {
  std::error_code code;
  const std::uintmax_t size = fs::is_regular_file(path, code) ? fs::file_size(path, code) : 0;
  const double megabytes = code ? 0.0 : static_cast<double>(size) / 1e6;
  ChildLimits limits;
  limits.cpu_s = 5.0 + 2.0 * megabytes;
  limits.wall_s = 30.0 + 3.0 * limits.cpu_s;  // the machine may be busy
  limits.memory_bytes += static_cast<std::size_t>(40e6 * megabytes);
  return limits;
}

Error died(const fs::path& path, const ChildOutcome& outcome, const ChildLimits& limits, const char* cure) {
  const std::string words = last_words(outcome.noise);
  switch (outcome.end) {
    case ChildEnd::not_started:
      return failure(path.string(),
                     fmt::format("no process could be started to read it ({})", std::strerror(outcome.code)),
                     "Close other programs and try again.");
    case ChildEnd::timed_out:
      return input_error(path.string(), fmt::format("the parser did not finish within {:.0f} s{}", limits.cpu_s, words),
                         cure);
    case ChildEnd::signalled:
      return input_error(
          path.string(),
          fmt::format("the parser stopped (signal {}, {}){}", outcome.code, strsignal(outcome.code), words), cure);
    case ChildEnd::exited:
    case ChildEnd::finished:
      break;
  }
  return input_error(path.string(), fmt::format("the parser gave up (exit status {}){}", outcome.code, words), cure);
}

Error threw(const fs::path& path, const char* what, const char* cure) {
  return input_error(path.string(), fmt::format("the parser gave up: {}", what), cure);
}

Error out_of_memory(const fs::path& path) {
  return input_error(path.string(), "reading it needs more memory than a file of its size should",
                     "The file is damaged (a wrong size in its header), or too large for this machine; crop it.");
}

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace stylet::detail {

struct ChildLimits {
  double cpu_s = 5.0;                               ///< processor time
  double wall_s = 60.0;                             ///< real time
  std::size_t memory_bytes = std::size_t{4} << 30;  ///< in addition to the memory that the parent uses
};

enum class ChildEnd { finished, signalled, exited, timed_out, not_started };

struct ChildOutcome {
  ChildEnd end = ChildEnd::not_started;
  int code = 0;        ///< signal number, exit status or errno, according to `end`
  std::string result;  ///< bytes returned by `work`, if it finished
  std::string noise;   ///< last part of the child's output to standard output and standard error
};

/// Runs `work` in a child process and returns the bytes that it produced. Any failure there (crash, abort, exit(),
/// endless loop, exhausted memory, output on the terminal) only becomes an outcome for the parent. The child cannot
/// write files and ends with its parent.
ChildOutcome run_in_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace stylet::detail {

struct ChildLimits {
  double cpu_s = 5.0;                               ///< processor time
  double wall_s = 60.0;                             ///< real time
  std::size_t memory_bytes = std::size_t{4} << 30;  ///< beyond what the parent already uses
};

enum class ChildEnd { finished, signalled, exited, timed_out, not_started };

struct ChildOutcome {
  ChildEnd end = ChildEnd::not_started;
  int code = 0;        ///< signal number, exit status or errno, according to `end`
  std::string result;  ///< what `work` returned, when finished
  std::string noise;   ///< last part of what was printed to standard output and standard error
};

/// Runs `work` in a child process and brings back the bytes it returns. Whatever happens in there (crash, abort,
/// exit(), endless loop, memory without end, chatter on the terminal) reaches the parent as an outcome only. The child
/// cannot write files and dies with its parent.
ChildOutcome run_in_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace stylet::detail

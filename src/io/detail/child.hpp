// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace stylet::detail {

struct ChildLimits {
  double cpu_s = 5.0;                               ///< processor time
  double wall_s = 60.0;                             ///< real time
  std::size_t memory_bytes = std::size_t{4} << 30;  ///< in addition to the memory that the process begins with
};

/// timed_out: it had all of its processor time; overdue: all of its real time, but not of its processor time
enum class ChildEnd { finished, signalled, exited, timed_out, overdue, not_started };

struct ChildOutcome {
  ChildEnd end = ChildEnd::not_started;
  int code = 0;        ///< signal number, exit status or errno, according to `end`
  std::string result;  ///< bytes that the child answered with, if it finished
  std::string noise;   ///< last part of the child's output to standard output and standard error
};

inline constexpr char kCompleteMark = '\x17';  ///< last byte of a complete answer; missing if the child died before it
inline constexpr int kAnswerPipe = 3;          ///< number of the file on which an executed program answers

/// Runs `work` in a copy of this process and returns the bytes that it produced. Any failure there (crash, abort,
/// exit(), endless loop, exhausted memory, output on the terminal) only becomes an outcome for the parent. The child
/// cannot write files and ends with its parent.
ChildOutcome run_in_child(const std::function<std::string()>& work, const ChildLimits& limits);

/// Executes a program, which reads `input` from its standard input and answers on kAnswerPipe. It gets no other file
/// of this process, and sets its limits itself but that of real time.
ChildOutcome run_program(const std::filesystem::path& program, std::string_view input, const ChildLimits& limits);

}  // namespace stylet::detail

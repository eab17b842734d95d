// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/child.hpp"
#include "detail/wire.hpp"
#include "reading/task.hpp"
#include "stylet/core/result.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>

/// Files of unknown origin are parsed by a program of its own, `stylet-reader`, with limits of time and memory and
/// without the right to do anything but read files and answer (reading/program.hpp). A parser that crashes, hangs or is
/// taken over cannot do harm; the caller gets an input error.
namespace stylet::detail {

/// The request that the program reads from its standard input.
struct ReadingRequest {
  std::string release;    ///< of the asking program, which must be that of the reading one
  long parent = 0;        ///< process number of the asking program
  double cpu_s = 0.0;     ///< limit of processor time
  std::size_t bytes = 0;  ///< limit of memory, beyond what the program itself takes
  std::string task;       ///< name
  std::string arguments;  ///< path and arguments of the task, by wire.hpp
};
void fields(auto& wire, ReadingRequest& r) { wire(r.release, r.parent, r.cpu_s, r.bytes, r.task, r.arguments); }

/// The release that this program is of, as "0.2.0": requests and answers are the same in all builds of a release.
std::string this_release();

/// Limits for reading one file or searching one folder: generous for valid files of its packed and unpacked size, but
/// short enough that a malicious file does not seem to hang the program. The unpacked size that a file claims is
/// bounded by the largest ratio that deflate can achieve.
ChildLimits limits_for(const std::filesystem::path& path);

/// The errors for a parser that threw an exception, and for one that asked for too much memory.
Error threw(const std::filesystem::path& path, const char* cure);
Error out_of_memory(const std::filesystem::path& path);

/// The bytes that a task answers with, those of a Result. Errors: the program is missing, or it ended without an
/// answer: by a crash, at one of its limits, or because the parser ended it.
/// @param path the file, or the place in messages if the bytes to parse are among the arguments
Result<std::string> answer_bytes(std::string_view task, const std::filesystem::path& path, std::string arguments,
                                 const char* cure);

/// Inside of the reading program: from now on answer_bytes() calls this function instead of starting the program again,
/// so that a parser may use any public reader.
void answer_here(std::function<std::string(std::string_view task, std::string_view arguments)> answer);

/// Has the reading program carry out a task. Errors: those of the parser, and those of answer_bytes().
template <class Answer, class... Arguments>
Result<Answer> ask(const Task<Answer, Arguments...>& task, const std::filesystem::path& path,
                   std::type_identity_t<Arguments>... arguments) {
  WireWriter wire;
  std::string file = path.string();
  wire(file, arguments...);
  const Result<std::string> bytes = answer_bytes(task.name, path, std::move(wire.bytes), task.cure);
  if (!bytes) return bytes.error();
  try {
    return from_bytes<Answer>(*bytes);
  } catch (const std::exception&) {
    return threw(path, task.cure);
  }
}

}  // namespace stylet::detail

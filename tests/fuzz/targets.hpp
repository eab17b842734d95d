// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/file_kind.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stylet::fuzz {

/// A task of the reading program with the files that a fuzzer makes for it.
struct Target {
  std::string name;  ///< that of the task; with the kind of file behind it if the task takes several: "parse_mask-nrrd"
  std::string task;
  detail::FileKind kind = detail::FileKind::unknown;  ///< of the file, for a task that takes several
  std::string ending = "";                            ///< of the file's name, which some parsers look at
  std::string seeds = name;                           ///< target whose first inputs these are
};

/// The targets of a task: one, or one for each kind of file that it takes.
std::vector<Target> targets_of(const std::string& task);

/// The arguments behind the path in a request for the target's task; those that a user may choose are not set.
/// @param input the bytes of the file, which are an argument themselves if the task takes a text
std::string arguments_of(const Target& target, std::string_view input);

/// The name of the target that a request belongs to, and the input of a fuzzer for it.
/// @param arguments those behind the path
std::string target_of(const std::string& task, std::string_view arguments);
std::vector<std::string> inputs_of(const std::string& task, const std::string& path, std::string_view arguments);

/// A mesh of TetGen is two files; in an input a NUL is between them.
inline constexpr char kBetweenFiles = '\0';

}  // namespace stylet::fuzz

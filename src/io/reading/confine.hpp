// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

namespace stylet::detail {

/// Takes from this process, for good, all rights that a parser does not need. What remains are reading files, memory,
/// clocks and the pipes that are open already. By a filter of system calls (seccomp), everything else is answered as if
/// this system did not have it: sockets, other programs and processes, threads, opening a file for writing, removing or
/// renaming one. Where the kernel has Landlock, it refuses the same for files once more, by what is done rather than by
/// which call. Failure: the kernel has no filters of system calls.
Result<> confine();

}  // namespace stylet::detail

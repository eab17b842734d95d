// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <csetjmp>
#include <string_view>

/// Faults of libraries that are known already. The first of each kind ends the fuzzer, with a report, unless it is in a
/// child (child.hpp); later ones end the execution only, since a start costs as much as hundreds of executions. The
/// reading program is ended by all of them, which its caller answers with an error.
namespace stylet::fuzz {

/// Takes the signals SIGSEGV, SIGBUS, SIGFPE and SIGABRT over from libFuzzer and the address sanitizer, and looks at
/// the sanitizer's reports. The places of known faults stand in STYLET_FUZZ_KNOWN, separated by blanks:
/// "libvtkIOXML-9.1.so.1+0x98753". Each of them that happens is counted as a byte of the file "known" in this folder.
void pass_over_known_faults();

/// Adds a place to those of STYLET_FUZZ_KNOWN.
void add_known_place(std::string_view place);

/// For the end of a child after a check of the sanitizer's own, as of memory that a library has damaged.
void at_end_of_child();

/// Where an execution that a known fault ends goes on. To be set by sigsetjmp() before each.
extern sigjmp_buf after_known_fault;

}  // namespace stylet::fuzz

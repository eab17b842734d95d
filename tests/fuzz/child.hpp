// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

/// Executions in a child of the fuzzer. A fault of HDF5 or gmsh leaves them in a state in which they read no other
/// file, and one of VTK may leave its memory damaged, so the process it happened in must end. A new child is made in
/// some milliseconds; a new fuzzer would read all of its inputs again.
namespace stylet::fuzz {

/// Lets the child read an input, and takes over what it covered. Where the child ends at a known fault
/// (library_faults.hpp), the next input has a new one, and also at the first fault at a place in a library: the input
/// is kept in this folder as "fault-PLACE" then, and a line with this name ends the child's report. At any other the
/// fuzzer ends, behind the child's report.
/// @param read reads the input, in the child
/// @param faults known ones that a child may go on after
void run_in_child(std::string_view input, int faults, void (*read)(std::string_view input));

/// Ends this process if it is a child: at the known fault after which it may not go on, at one that it may not survive,
/// after a report of the sanitizer, or with a report of its own
/// where a reader called abort(), for which libFuzzer would keep an input that is not the child's.
void end_child_at_last_fault();
void end_child_at_known_fault();
void end_child_after_report();
void end_child_by_itself();

bool is_child();

/// To be called in a child before it ends at a fault that is not known: where in a library it is.
void note_place(std::string_view place);

/// To be called before libFuzzer closes the standard error, for the reports of children.
void keep_stderr_for_children();

}  // namespace stylet::fuzz

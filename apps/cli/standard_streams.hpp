// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::cli {

/// Must be called before anything else. Opens closed standard streams as /dev/null: otherwise the next opened file
/// would get the number of a standard stream and printed text would go into it. Also ignores SIGPIPE and SIGXFSZ, so
/// that a closed pipe and a limit on the size of files are errors of writing and do not end the program.
/// @return whether standard output was open
bool prepare_standard_streams();

}  // namespace stylet::cli

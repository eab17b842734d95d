// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::cli {

/// To be called before anything else. Standard streams that are closed become /dev/null, since a file that is opened
/// would get their number, and whatever is printed would go into it. A reader who goes away is an error of writing, not
/// the end of the program.
/// @return whether standard output was open
bool prepare_standard_streams();

}  // namespace stylet::cli

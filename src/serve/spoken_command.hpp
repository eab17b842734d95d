// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "commands.hpp"
#include "stylet/core/result.hpp"

#include <string>

namespace stylet::serve {

/// A command of another program, as the JSON of a page, such as {"do": "hole", "hole": "D4"}, or in words: its word and
/// its arguments, such as `hole D4`. `start again` is `reset`. Errors: no such command, a missing or wrong argument,
/// and commands that are for pages only (those that do not need the needle).
Result<Command> spoken_command(const std::string& text);

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace stylet::serve {

/// The token in a file that only this user can read; a new one, kept there, if there is none yet or others could have
/// read it. So the address stays the same from start to start, and a page that is open finds the next server.
/// @param file empty, or one that cannot be written: the token is good for this start only
std::string kept_token(const std::filesystem::path& file);

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace stylet::serve {

/// Reads the token from a file that only this user can read. If there is none, or others could have read the file,
/// makes a new token and stores it there. So the address stays the same from start to start, and an open page can
/// connect to the next server.
/// @param file if it is empty or cannot be written, the token is new at every start
std::string kept_token(const std::filesystem::path& file);

}  // namespace stylet::serve

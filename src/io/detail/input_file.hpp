// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>

namespace stylet::detail {

/// Checks that a path is a file that can be opened and read to its end. Errors: nothing there, a folder, a named pipe,
/// a device, a socket, no permission. The kind is checked before opening, since opening a named pipe would wait for its
/// other end. Every reader calls this first.
Result<> check_input_file(const std::filesystem::path& path);

/// The data file that a header names. It must be in the header's folder or below it, so that a file of unknown origin
/// cannot make the program read arbitrary files.
/// @param header the file with the header
/// @param name of the data file as written in the header
/// Errors: an absolute path, a path with "..", a link that leads out of the folder; errors of check_input_file().
Result<std::filesystem::path> data_file_of(const std::filesystem::path& header, const std::string& name);

}  // namespace stylet::detail

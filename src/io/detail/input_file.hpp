// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>

namespace stylet::detail {

/// Refuses whatever is not a file that can be opened and read to its end: nothing there, a folder, a named pipe, a
/// device, a socket, no permission. Looks before it opens, since opening a named pipe waits for its other end. Every
/// reader asks this first.
Result<> check_input_file(const std::filesystem::path& path);

/// The file that a header names as the place of its data: in the header's folder or below it. A file from elsewhere
/// must not make the program read what its sender chooses.
/// @param header the file that names it
/// @param name as the header writes it
/// Errors: an absolute path, a path with "..", a link that leads out of the folder, and those of check_input_file().
Result<std::filesystem::path> data_file_of(const std::filesystem::path& header, const std::string& name);

}  // namespace stylet::detail

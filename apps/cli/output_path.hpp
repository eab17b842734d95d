// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string_view>

namespace stylet::cli {

/// Refuses, before any work is done, a file that cannot be written: a folder of that name, or a place that does not
/// exist and cannot be made or is not writable. Creates nothing.
Result<> check_output_file(const std::filesystem::path& path);

/// The same for a folder, which may exist or not.
Result<> check_output_folder(const std::filesystem::path& path);

/// Makes a folder with all above it; does nothing when it is there.
Result<> make_folder(const std::filesystem::path& path);

/// Writes a text file that appears whole or not at all, and the folder it is to lie in.
Result<> write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace stylet::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace stylet::cli {

/// Checks, before any work is done, that a file can be written. Creates nothing. Errors: a folder of this name exists,
/// or the file's folder does not exist and cannot be made, or is not writable. A full disk is an error of the kind
/// `failed`, all others are of the kind `input`.
Result<> check_output_file(const std::filesystem::path& path);

/// Checks that a folder exists or can be made, and is writable. Creates nothing.
Result<> check_output_folder(const std::filesystem::path& path);

/// The folder for the results of a scenario: the wanted one, or out/NAME of the scenario's file.
inline std::filesystem::path result_folder(const std::string& wanted, const std::filesystem::path& scenario) {
  return wanted.empty() ? "out" / scenario.stem() : std::filesystem::path(wanted);
}

/// Writes a text file by write_whole_file(), and makes its folder.
Result<> write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace stylet::cli

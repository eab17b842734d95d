// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string_view>

namespace stylet {

/// Makes a folder and those above it, and waits until they are on the disk. Does nothing if the folder exists.
/// Errors: `failed` if the disk is full, otherwise `input`.
Result<> make_folder(const std::filesystem::path& folder);

/// Checks that the folder, which exists, takes files: writes a small one and removes it. Permissions alone do not say
/// whether the disk is full or may only be read.
/// Errors: `failed` if the disk is full, otherwise `input`.
Result<> check_writable(const std::filesystem::path& folder);

/// Who may read a file: whom the user's umask permits, or the user alone.
enum class FileReaders { usual, owner };

/// Writes a file, which gets its name when all of it is on the disk: after an error, a kill or a power cut the earlier
/// file of that name, or none, is there. Pipes and devices are written as they are.
/// @param path of the file; its folder must exist
/// Errors: `failed`.
Result<> write_whole_file(const std::filesystem::path& path, std::string_view content,
                          FileReaders readers = FileReaders::usual);

}  // namespace stylet

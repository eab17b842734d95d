// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace stylet::detail {

/// Whether this error of the system says that nothing more fits on the disk, or in the user's share of it.
bool means_full(int reason);

/// The error of a file or folder that cannot be written; its kind is `failed`.
/// @param reason errno of the call that failed
/// @param bytes size of the file; 0: unknown
Error write_error(const std::filesystem::path& path, int reason, std::uintmax_t bytes = 0);

/// Writes all bytes. @return 0, or errno of the call that failed
int write_all(int descriptor, std::string_view bytes);

/// Waits until the content of an open file, or the names in an open folder, are on the disk. Places that know no such
/// wait, such as pipes, have none. @return 0, or errno of the call that failed
int sync(int descriptor);

/// Waits until the content of a file, or the names in a folder, are on the disk. Errors: write_error().
Result<> sync(const std::filesystem::path& path);

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace stylet::detail {

/// Makes a folder that only this user can enter, whatever the umask; does not change a folder that exists. Its parent
/// folders are made with default permissions. Errors are not reported here: they show when a file is written there.
void make_private_folder(const std::filesystem::path& folder);
/// Makes an existing file readable and writable for this user only.
void make_private(const std::filesystem::path& file);

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace stylet::detail {

/// Makes a folder that only this user can enter, whatever the umask; does not change a folder that exists. Its parent
/// folders are made with default permissions. Errors are not reported here: they show when a file is written there.
void make_private_folder(const std::filesystem::path& folder);
/// Makes an empty file that only this user can read and write, whatever the umask, for a writer that opens it again;
/// does nothing if there is a file of this name. Errors show when the file is written.
void make_private_file(const std::filesystem::path& file);
/// Makes an existing file readable and writable for this user only.
void make_private(const std::filesystem::path& file);

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace stylet::serve {

/// Makes a folder that only this user can enter, whatever the umask; leaves one that is there as it is. Folders above
/// it are made as usual. What fails shows when something is to be written there.
void make_private_folder(const std::filesystem::path& folder);
/// From now on only this user can read a file, whatever the umask.
void make_private(const std::filesystem::path& file);

}  // namespace stylet::serve

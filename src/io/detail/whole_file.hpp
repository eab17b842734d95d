// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <functional>

namespace stylet::detail {

/// Writes a file so that it appears whole or not at all: `write` fills a temporary file beside `path`, which then takes
/// its place in one step. On any error the temporary is removed and whatever was at `path` stays.
/// @param path where the file shall be; its folder must exist
/// @param write fills the file it is given; an Error it returns is passed on
Result<> write_whole(const std::filesystem::path& path,
                     const std::function<Result<>(const std::filesystem::path&)>& write);

}  // namespace stylet::detail

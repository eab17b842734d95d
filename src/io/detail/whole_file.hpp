// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <functional>

namespace stylet::detail {

/// Writes a file atomically: `write` fills a temporary file in the same folder, which is then renamed to `path`. On any
/// error the temporary file is removed and an existing file at `path` stays unchanged.
/// @param path of the file; its folder must exist
/// @param write writes the content to the path it is given; its Error is passed on
Result<> write_whole(const std::filesystem::path& path,
                     const std::function<Result<>(const std::filesystem::path&)>& write);

}  // namespace stylet::detail

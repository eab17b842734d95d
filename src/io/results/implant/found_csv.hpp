// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>

namespace stylet::results {

/// Removes what an earlier run wrote about found seeds into the folder of results of an implant: found.csv, and the
/// dose.json by which the folder found is complete. A found.csv with another first line is the user's own and stays.
/// Errors: a file cannot be removed.
Result<> remove_earlier_found(const std::filesystem::path& folder);

}  // namespace stylet::results

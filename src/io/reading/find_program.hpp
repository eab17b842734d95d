// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>

namespace stylet::detail {

/// Where `stylet-reader` is: what the environment variable STYLET_READER names, else beside the running program, in
/// libexec/stylet of the installation that the program or this library belongs to, or where this build installs it.
/// Failure: in none of these places.
Result<std::filesystem::path> find_reading_program();

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/igtl/link.hpp"

namespace stylet::igtl {

/// Checks the settings. Errors: values out of range, names that are empty, invalid or used twice.
Result<> check(const LinkSettings& settings);

}  // namespace stylet::igtl

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/igtl/link.hpp"

namespace stylet::igtl {

/// What is wrong with the settings, if anything.
Result<> check(const LinkSettings& settings);

}  // namespace stylet::igtl

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/remarks.hpp"

namespace stylet::detail {

/// Passes a sentence to the receiver of remarks, unless it has had the same one before.
void remark(const std::string& sentence);

}  // namespace stylet::detail

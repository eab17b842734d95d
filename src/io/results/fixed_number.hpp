// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet::results {

/// Fixed-point text; a value that rounds to zero prints without a sign, so that no column flickers between 0 and -0.
std::string fixed(double value, int digits);

}  // namespace stylet::results

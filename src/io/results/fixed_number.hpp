// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet::results {

/// A number with a fixed number of decimals. A value that rounds to zero prints without a sign, so that a column does
/// not alternate between 0 and -0.
std::string fixed(double value, int digits);

}  // namespace stylet::results

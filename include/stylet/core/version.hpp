// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Version of the library as "major.minor.patch".
const char* version();

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/version.hpp"

namespace stylet {

const char* version() { return STYLET_VERSION; }

}  // namespace stylet

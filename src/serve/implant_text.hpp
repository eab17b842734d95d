// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/serve/implant_picture.hpp"

#include <string>

namespace stylet::serve {

// The JSON texts of the messages about an implant (docs/live_protocol.md).
std::string plan_text(const ShownPlan& shown);
std::string implant_text(const LiveImplant& implant);
std::string seeds_text(const LiveSeeds& seeds);

}  // namespace stylet::serve

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/seed_errors.hpp"

#include <string>

namespace stylet::results {

/// The picture of why seeds do not lie where they were planned, as SVG: for all causes together and for each cause that
/// moved a seed, the mean size and the mean along each axis as bars. Empty where no cause moved a seed.
std::string cause_picture(const ImplantHistory& history);

}  // namespace stylet::results

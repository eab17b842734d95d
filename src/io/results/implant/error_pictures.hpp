// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/seed_errors.hpp"

#include <string>

namespace stylet::results {

/// Three pictures, one for each axis, as figures: the signed error of each seed over its planned position from inferior
/// to superior, with a mark for each third. All have the same scales. A note where no seed is left.
std::string error_pictures(const ImplantHistory& history);

/// The legend of the marks, as HTML.
std::string third_key(const ImplantHistory& history);

}  // namespace stylet::results

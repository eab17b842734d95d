// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/page_template.hpp"
#include "stylet/dose/dose_plan.hpp"

namespace stylet::results {

/// Adds the sentences of the page that speak of seeds and needles, or of dwell positions and catheters, as HTML.
void add_kind_words(Slots& slots, Implant implant);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/page_template.hpp"

#include <string>

namespace stylet::results {

/// A page about a dose. @param slots those of whole_page() but for what such pages have in common; and dvh_file, the
/// file that readers without a script find the histograms in
Result<std::string> page_about_dose(const PageAssets& page, Slots slots);

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

/// The report's page, style sheet and script (web/report/), which the build puts into the library.
namespace stylet::results {

std::string_view report_template();  ///< HTML with {{slots}}
std::string_view report_css();
std::string_view report_js();

}  // namespace stylet::results

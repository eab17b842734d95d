// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/page_template.hpp"

#include <string>
#include <string_view>

namespace stylet::results {

/// A page about a dose: what such pages have in common, around a body of its own.
/// @param body HTML with slots @param slots those of the body and of web/report/dose_shell.html, but for the version;
/// and dvh_file, the file that readers without a script find the histograms in
Result<std::string> page_about_dose(std::string_view body, Slots slots);

}  // namespace stylet::results

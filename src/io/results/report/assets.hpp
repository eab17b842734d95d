// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

/// Pages of web/report/, which the build embeds into the library.
namespace stylet::results {

/// The parts of a page: its body (HTML with {{slots}}), its style sheet and its script.
struct PageAssets {
  std::string_view body, css, js;
};

PageAssets report_assets();     ///< the report of an insertion
PageAssets dose_assets();       ///< the page of stylet dose
PageAssets implant_assets();    ///< the page of stylet implant
PageAssets reproduce_assets();  ///< the page of stylet reproduce
PageAssets validate_assets();   ///< the page of stylet validate

std::string_view page_shell();  ///< HTML with {{slots}}, around the body of every page

}  // namespace stylet::results

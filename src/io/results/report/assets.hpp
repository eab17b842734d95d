// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

/// Pages, style sheets and scripts of web/report/, which the build embeds into the library: for the report of an
/// insertion and for the pages of stylet dose, stylet implant, stylet reproduce and stylet validate.
namespace stylet::results {

std::string_view report_template();  ///< HTML with {{slots}}
std::string_view report_css();
std::string_view report_js();

std::string_view dose_shell();  ///< HTML with {{slots}}, around the bodies of dose and implant

std::string_view dose_template();  ///< HTML with {{slots}}, the body of the page
std::string_view dose_css();
std::string_view dose_js();

std::string_view implant_template();  ///< HTML with {{slots}}, the body of the page
std::string_view implant_css();
std::string_view implant_js();

std::string_view reproduce_template();  ///< HTML with {{slots}}
std::string_view reproduce_css();
std::string_view reproduce_js();

std::string_view validate_template();  ///< HTML with {{slots}}
std::string_view validate_css();
std::string_view validate_js();

}  // namespace stylet::results

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/assets.hpp"
#include "stylet/core/result.hpp"

#include <map>
#include <string>
#include <string_view>

namespace stylet::results {

/// Texts for the placeholders {{name}} of a page, by name.
using Slots = std::map<std::string, std::string, std::less<>>;

/// Fills the placeholders of a page. A placeholder without a text is an error of the build. @param name of the page for
/// the message
Result<std::string> fill_page(std::string_view page, const Slots& slots, const std::string& name);

/// A whole page: its body in the shell of all pages, with its style sheet and its script.
/// @param slots those of the body and of web/report/shell.html, but for the style sheet, the script and the program's
/// version. They may lack heading (then the title), kind (of computation, for the disclaimer), more_css, no_script and
/// more_data
Result<std::string> whole_page(const PageAssets& page, Slots slots, const std::string& name);

}  // namespace stylet::results

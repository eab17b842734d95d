// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

/// The files of the live page (web/live/), which the build embeds into the library.
namespace stylet::serve {

std::string_view page();    ///< index.html, which loads /live.js and /live.css
std::string_view script();  ///< live.js
std::string_view style();   ///< live.css

}  // namespace stylet::serve

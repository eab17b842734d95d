// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

}  // namespace stylet::results

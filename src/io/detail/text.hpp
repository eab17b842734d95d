// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stylet::detail {

/// Without blanks, tabs, line ends and NULs at both ends.
std::string trimmed(std::string_view text);

/// In lower case (ASCII letters only).
std::string lower(std::string_view text);

/// Parts between separators; empty parts are kept.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The number a text is, blanks at the ends allowed, nothing else beside it; independent of the locale.
std::optional<double> to_number(std::string_view text);

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// Numbers and paragraphs of the page.
namespace stylet::reproduce {

/// 5·10⁻¹³: a small number by its order.
std::string order(double value);

/// Three significant digits, without an exponent down to 1e-4.
std::string digits(double value);

/// A time with the unit that suits it.
std::string duration(double seconds);

/// @param text plain, with the marks results::html_prose() knows
std::string paragraph(const std::string& text);

}  // namespace stylet::reproduce

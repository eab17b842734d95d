// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// Formats numbers and paragraphs of the page.
namespace stylet::reproduce {

/// A small number with one digit and its order of magnitude: "5·10⁻¹³".
std::string order(double value);

/// Three significant digits; from 1e-4 on without an exponent.
std::string digits(double value);

/// A time in µs, ms or s, with its unit.
std::string duration(double seconds);

/// An HTML paragraph. @param text plain text with the marks of results::html_prose()
std::string paragraph(const std::string& text);

}  // namespace stylet::reproduce

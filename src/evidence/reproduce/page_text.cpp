// SPDX-License-Identifier: GPL-3.0-or-later
#include "page_text.hpp"

#include "report/text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace stylet::reproduce {

std::string order(double value) {
  if (!(value > 0.0)) return "0";
  static const std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  int exponent = static_cast<int>(std::floor(std::log10(value)));
  if (std::round(value / std::pow(10.0, exponent)) >= 10.0) ++exponent;
  std::string text = fmt::format("{:.0f}·10", value / std::pow(10.0, exponent));
  if (exponent < 0) text += "⁻";
  for (const char digit : std::to_string(std::abs(exponent))) text += raised[static_cast<std::size_t>(digit - '0')];
  return text;
}

std::string digits(double value) {
  const double size = std::abs(value);
  if (!std::isfinite(value)) return "–";
  if (size == std::floor(size) && size < 1e6) return fmt::format("{:.0f}", value);
  if (size >= 99.95) return fmt::format("{:.0f}", value);
  if (size >= 9.995) return fmt::format("{:.1f}", value);
  if (size >= 0.9995) return fmt::format("{:.2f}", value);
  if (size >= 1e-4) return fmt::format("{:.{}f}", value, 2 - static_cast<int>(std::floor(std::log10(size))));
  return order(value);
}

std::string duration(double seconds) {
  const double size = std::abs(seconds);
  if (size < 1e-3) return digits(1e6 * seconds) + " µs";
  if (size < 1.0) return digits(1e3 * seconds) + " ms";
  return digits(seconds) + " s";
}

std::string paragraph(const std::string& text) { return "<p>" + results::html_prose(text) + "</p>"; }

}  // namespace stylet::reproduce

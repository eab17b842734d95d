// SPDX-License-Identifier: GPL-3.0-or-later
#include "fixed_number.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::results {

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  const bool zero = std::abs(value) < 0.5 * std::pow(10.0, -digits);
  return fmt::format("{:.{}f}", zero ? 0.0 : value, digits);
}

}  // namespace stylet::results

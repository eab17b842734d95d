// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/round_number.hpp"

#include <cmath>
#include <initializer_list>

namespace stylet::results {

double round_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double leading = value / power;
  return power * (leading >= 5.0 ? 5.0 : leading >= 2.0 ? 2.0 : 1.0);
}

double round_above(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double leading : {1.0, 2.0, 2.5, 5.0}) {
    if (leading * power >= value * (1.0 - 1e-9)) return leading * power;
  }
  return 10.0 * power;
}

}  // namespace stylet::results

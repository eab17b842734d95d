// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <cmath>
#include <string>

namespace stylet {

/// Text of a number without trailing zeros, for messages.
inline std::string number_text(double value) {
  std::string text = std::to_string(value);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

inline bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

inline Error not_positive(const char* name, const char* unit, double value) {
  return input_error(std::string("needle, ") + name,
                     number_text(value) + " " + unit + ", expected a finite number above 0",
                     std::string("Give the needle's ") + name + " in " + unit);
}

}  // namespace stylet

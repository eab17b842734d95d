// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/result.hpp"

namespace stylet {

std::string Error::message() const {
  std::string text = where;
  if (!text.empty() && !what.empty()) text += ": ";
  text += what;
  if (!cure.empty()) {
    if (!text.empty() && text.back() != '.' && text.back() != '?') text += '.';
    text += ' ' + cure;
  }
  return text;
}

}  // namespace stylet

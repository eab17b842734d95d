// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace stylet {

/// Whether two secret words are equal. Takes as long whether the first or the last character differs.
inline bool is_same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned differ = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    differ |= static_cast<unsigned>(static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]));
  return differ == 0;
}

}  // namespace stylet

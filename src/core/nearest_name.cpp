// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <vector>

namespace stylet {

namespace {

bool same(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table d(i, j), the distance between the first i characters of a and the first j of b. A swap
  // needs the row d(i − 2, ·).
  std::vector<int> before_last(b.size() + 1);
  std::vector<int> last(b.size() + 1);
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1])) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::string nearest_name(std::string_view mistyped, std::span<const std::string> known) {
  int best = std::numeric_limits<int>::max();
  std::string nearest;
  for (const std::string& name : known) {
    const int distance = edit_distance(mistyped, name);
    if (distance < best) {
      best = distance;
      nearest = name;
    }
  }
  const int longer = static_cast<int>(std::max(mistyped.size(), nearest.size()));
  return best <= std::max(1, longer / 3) ? nearest : std::string();
}

}  // namespace stylet

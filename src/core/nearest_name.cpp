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

/// The words of a name, in small letters: "speed_mm_per_s" has speed, mm, per and s.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  bool inside = false;
  for (const char c : name) {
    const bool belongs = std::isalnum(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
    if (belongs && !inside) words.emplace_back();
    if (belongs) words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    inside = belongs;
  }
  return words;
}

/// Shorter words are units or say nothing: mm, per, s, of.
constexpr std::size_t kTelling = 4;

/// Number of words of `mistyped` that `name` has too. A first word counts however short it is, and longer words may
/// differ by a typing error.
int shared_words(const std::vector<std::string>& mistyped, const std::vector<std::string>& name) {
  int shared = 0;
  for (std::size_t i = 0; i < mistyped.size(); ++i) {
    const std::string& word = mistyped[i];
    if (i == 0 && !name.empty() && name.front() == word) {
      ++shared;
    } else if (word.size() >= kTelling) {
      const int most = word.size() > kTelling ? 1 : 0;
      shared += std::any_of(name.begin(), name.end(), [&](const std::string& other) {
        return other.size() >= kTelling && edit_distance(word, other) <= most;
      });
    }
  }
  return shared;
}

/// The name that shares most words with `mistyped`, and of several the shortest; empty if none shares a word.
std::string name_with_words_of(std::string_view mistyped, std::span<const std::string> known) {
  const std::vector<std::string> wanted = words_of(mistyped);
  int most = 0;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  std::string best;
  for (const std::string& name : known) {
    const std::vector<std::string> words = words_of(name);
    const int shared = shared_words(wanted, words);
    if (shared == 0 || shared < most || (shared == most && words.size() >= fewest)) continue;
    most = shared;
    fewest = words.size();
    best = name;
  }
  return best;
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
  return best <= std::max(1, longer / 3) ? nearest : name_with_words_of(mistyped, known);
}

}  // namespace stylet

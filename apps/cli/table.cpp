// SPDX-License-Identifier: GPL-3.0-or-later
#include "table.hpp"

#include <algorithm>

namespace stylet::cli {

namespace {

/// Number of characters of UTF-8 text; a terminal shows each in one column.
std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, columns(text)), ' ');
  return right ? blanks + text : text + blanks;
}

bool starts_like_a_number(const std::string& cell) {
  return !cell.empty() && ((cell[0] >= '0' && cell[0] <= '9') || cell[0] == '-' || cell[0] == '+');
}

void trim_right(std::string& line) { line.erase(line.find_last_not_of(' ') + 1); }

}  // namespace

std::string Table::text() const {
  std::vector<std::size_t> width;
  std::vector<bool> right;
  for (std::size_t column = 0; column < header_.size(); ++column) {
    width.push_back(columns(header_[column]));
    for (const auto& row : rows_) width.back() = std::max(width.back(), columns(row[column]));
    right.push_back(std::all_of(rows_.begin(), rows_.end(), [column](const auto& row) {
      return row[column].empty() || starts_like_a_number(row[column]);
    }));
  }
  std::string text;
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string out;
    for (std::size_t column = 0; column < header_.size(); ++column) {
      out += "  " + padded(cells[column], width[column], right[column]);
    }
    trim_right(out);
    if (!text.empty()) text += '\n';
    text += out;
  };
  line(header_);
  for (const auto& row : rows_) line(row);
  return text;
}

std::string Facts::text() const {
  std::size_t width = 0;
  for (const auto& [name, value] : rows_) width = std::max(width, columns(name));
  std::string text;
  for (const auto& [name, value] : rows_) {
    if (!text.empty()) text += '\n';
    text += "  " + padded(name, width, false) + "  " + value;
    trim_right(text);
  }
  return text;
}

}  // namespace stylet::cli

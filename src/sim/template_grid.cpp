// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/scenario.hpp"

#include <algorithm>

namespace stylet {

Result<std::array<double, 2>> TemplateGrid::offset_mm(const std::string& hole) const {
  for (std::size_t column = 0; column < columns.size(); ++column) {
    const std::string& letter = columns[column];
    if (hole.rfind(letter, 0) != 0) continue;
    std::string row_text = hole.substr(letter.size());
    if (row_text.size() > 2 && row_text.ends_with(".0")) row_text.resize(row_text.size() - 2);
    const auto row = std::find(rows.begin(), rows.end(), row_text);
    if (row == rows.end()) continue;
    const double left = (static_cast<double>(column) - 0.5 * static_cast<double>(columns.size() - 1)) * pitch_mm;
    const double anterior =
        (static_cast<double>(row - rows.begin()) - 0.5 * static_cast<double>(rows.size() - 1)) * pitch_mm;
    return std::array<double, 2>{left, anterior};
  }
  return input_error("template hole '" + hole + "'",
                     "there is no such hole: columns are " + columns.front() + " … " + columns.back() + ", rows " +
                         rows.front() + " … " + rows.back(),
                     "Write a column and a row, for example D4 or d3.5");
}

}  // namespace stylet

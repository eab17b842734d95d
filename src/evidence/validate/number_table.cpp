// SPDX-License-Identifier: GPL-3.0-or-later
#include "number_table.hpp"

#include "detail/csv.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::validate {

Result<std::vector<std::vector<double>>> read_number_table(const std::filesystem::path& file,
                                                           const std::vector<std::string>& names) {
  auto csv = detail::read_csv_lines(file);
  if (!csv) return csv.error();
  auto line = csv->lines.begin();
  std::vector<std::size_t> wanted;
  if (line != csv->lines.end() && names.empty()) {
    for (std::size_t k = 0; k < line->fields.size(); ++k) wanted.push_back(k);
  } else if (line != csv->lines.end()) {
    for (const std::string& name : names) {
      const auto found = std::find(line->fields.begin(), line->fields.end(), name);
      if (found == line->fields.end())
        return input_error(file.string(), fmt::format("there is no column '{}'", name),
                           "Use the file as it was published");
      wanted.push_back(static_cast<std::size_t>(found - line->fields.begin()));
    }
    ++line;
  }
  std::vector<std::vector<double>> columns(wanted.size());
  for (; line != csv->lines.end(); ++line) {
    std::vector<double> numbers;
    for (const std::size_t k : wanted) {
      const auto number = k < line->fields.size() ? detail::csv_number(line->fields[k]) : std::nullopt;
      if (!number) break;
      numbers.push_back(*number);
    }
    if (numbers.size() != columns.size()) continue;
    for (std::size_t k = 0; k < numbers.size(); ++k) columns[k].push_back(numbers[k]);
  }
  if (columns.empty() || columns.front().empty())
    return input_error(file.string(), "no line has numbers in all columns", "Use the file as it was published");
  return columns;
}

double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const auto next = std::upper_bound(xs.begin(), xs.end(), x);
  if (next == xs.begin()) return ys.front();
  if (next == xs.end()) return ys.back();
  const auto k = static_cast<std::size_t>(next - xs.begin());
  const double f = (x - xs[k - 1]) / (xs[k] - xs[k - 1]);
  return ys[k - 1] + f * (ys[k] - ys[k - 1]);
}

}  // namespace stylet::validate

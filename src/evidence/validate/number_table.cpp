// SPDX-License-Identifier: GPL-3.0-or-later
#include "number_table.hpp"

#include "detail/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace stylet::validate {

Result<std::vector<std::vector<double>>> read_number_table(const std::filesystem::path& file,
                                                           const std::vector<std::string>& names) {
  std::ifstream stream(file);
  std::string line;
  std::vector<std::size_t> wanted;
  if (!names.empty()) {
    std::getline(stream, line);
    const auto header = detail::split(line, ',');
    for (const std::string& name : names) {
      const auto found =
          std::find_if(header.begin(), header.end(), [&](const auto& field) { return detail::trimmed(field) == name; });
      if (found == header.end())
        return input_error(file.string(), fmt::format("there is no column '{}'", name),
                           "Use the file as it was published");
      wanted.push_back(static_cast<std::size_t>(found - header.begin()));
    }
  }
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(stream, line)) {
    const auto fields = detail::split(line, ',');
    if (wanted.empty()) {
      for (std::size_t k = 0; k < fields.size(); ++k) wanted.push_back(k);
      columns.resize(wanted.size());
    }
    std::vector<double> numbers;
    for (const std::size_t k : wanted) {
      const auto number = k < fields.size() ? detail::to_number(fields[k]) : std::nullopt;
      if (!number || !std::isfinite(*number)) break;
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

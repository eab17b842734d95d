// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/csv.hpp"

#include "detail/input_file.hpp"
#include "detail/text.hpp"
#include "reading/ask.hpp"
#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/tokenizer.hpp>
#include <cmath>
#include <fstream>

namespace stylet::detail {

namespace {

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  const boost::tokenizer<boost::escaped_list_separator<char>> tokens(line);
  for (const std::string& token : tokens) fields.push_back(trimmed(token));
  return fields;
}

}  // namespace

Result<CsvLines> read_csv_lines(const std::filesystem::path& path) {
  if (Result<> file = check_input_file(path); !file) return file.error();
  return ask(kCsvLines, path);
}

Result<CsvLines> parse_csv_lines(const std::filesystem::path& path) {
  constexpr std::size_t longest = 100000;
  CsvLines read;
  std::ifstream stream(path, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string where = fmt::format("{}, line {}", path.string(), number);
    if (line.find('\0') != std::string::npos || line.size() > longest)
      return input_error(where, "this is not a line of text", "Give a file of comma-separated values");
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // some spreadsheets write this mark
    line = trimmed(line);
    if (line.empty()) continue;
    if (line.front() == '#') {
      const auto colon = line.find(':');
      if (colon != std::string::npos) read.keys[trimmed(line.substr(1, colon - 1))] = trimmed(line.substr(colon + 1));
      continue;
    }
    try {
      read.lines.push_back({number, fields_of(line)});
    } catch (const std::exception&) {
      return input_error(where, "the line is not comma-separated values", "Check quotes and backslashes in this line");
    }
  }
  if (stream.bad()) return input_error(path.string(), "the file cannot be read to its end", "Copy it again");
  return read;
}

std::optional<double> csv_number(const std::string& field) {
  const auto number = to_number(field);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

bool CsvTable::has(const std::string& column) const {
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

std::string CsvTable::text(std::size_t row, const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? std::string() : rows[row][static_cast<std::size_t>(found - columns.begin())];
}

Result<double> CsvTable::number(std::size_t row, const std::string& column) const {
  const std::string value = text(row, column);
  if (const auto number = csv_number(value)) return *number;
  return input_error(fmt::format("{}, column {}", where(row), column),
                     fmt::format("'{}' is not a finite number", value), "Correct this field");
}

std::string CsvTable::where(std::size_t row) const { return fmt::format("{}, line {}", file, lines[row]); }

Result<CsvTable> read_csv_table(const std::filesystem::path& path, std::span<const std::string> known) {
  Result<CsvLines> read = read_csv_lines(path);
  if (!read) return read.error();
  CsvTable table;
  table.file = path.string();
  table.keys = std::move(read->keys);
  for (auto& [number, fields] : read->lines) {
    if (table.columns.empty()) {
      table.columns = fields;
      for (const std::string& column : fields) {
        if (std::find(known.begin(), known.end(), column) != known.end()) continue;
        const std::string near = nearest_name(column, known);
        return input_error(
            fmt::format("{}, line {}", table.file, number),
            fmt::format("the column '{}' is not known; the columns are {}", column, fmt::join(known, ", ")),
            near.empty() ? std::string("Use one of these names") : fmt::format("Did you mean '{}'?", near));
      }
      continue;
    }
    if (fields.size() != table.columns.size()) {
      return input_error(fmt::format("{}, line {}", table.file, number),
                         fmt::format("the line has {} fields, the header has {}", fields.size(), table.columns.size()),
                         "Give each line one field for each column");
    }
    table.rows.push_back(std::move(fields));
    table.lines.push_back(number);
  }
  if (table.rows.empty())
    return input_error(table.file, "the table has no rows", "Write a header line and at least one row");
  return table;
}

}  // namespace stylet::detail

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "reading/task.hpp"
#include "stylet/core/result.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet::detail {

/// A line of comma-separated values.
struct CsvLine {
  int number = 0;  ///< in the file, from 1
  std::vector<std::string> fields;
};

/// The lines of a file of comma-separated values. Lines "# key: value" give keys; other lines with '#' are comments.
/// Quoted fields are allowed. Empty lines are left out.
struct CsvLines {
  std::map<std::string, std::string> keys;  ///< of the lines "# key: value"
  std::vector<CsvLine> lines;
};

void fields(auto& wire, CsvLine& l) { wire(l.number, l.fields); }
void fields(auto& wire, CsvLines& l) { wire(l.keys, l.lines); }

/// Errors: the file cannot be read; a line that is no text, or no comma-separated values.
Result<CsvLines> read_csv_lines(const std::filesystem::path& path);
/// The same in the reading program.
inline constexpr Task<CsvLines> kCsvLines{"parse_csv_lines"};
Result<CsvLines> parse_csv_lines(const std::filesystem::path& path);

/// The finite number in a field; empty: it has none.
std::optional<double> csv_number(const std::string& field);

/// A table of comma-separated values with a header line (CsvLines).
struct CsvTable {
  std::string file;
  std::map<std::string, std::string> keys;  ///< of the lines "# key: value"
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
  std::vector<int> lines;                      ///< line of the file of each row, from 1

  [[nodiscard]] bool has(const std::string& column) const;
  /// Text of a field; empty if the table has no such column.
  [[nodiscard]] std::string text(std::size_t row, const std::string& column) const;
  /// Number of a field. Error: it is not a finite number; the message names file, line and column.
  [[nodiscard]] Result<double> number(std::size_t row, const std::string& column) const;
  [[nodiscard]] std::string where(std::size_t row) const;  ///< file and line for messages
};

/// Reads a table. Errors: the file cannot be read, a column that is not among `known` (with the nearest name), a row
/// with another number of fields, no rows.
Result<CsvTable> read_csv_table(const std::filesystem::path& path, std::span<const std::string> known);

}  // namespace stylet::detail

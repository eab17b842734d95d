// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "results/fixed_number.hpp"
#include "results/output_folder.hpp"
#include "stylet/core/field.hpp"

#include <fmt/format.h>

/// Records as lines of a CSV file.
namespace stylet::record {

/// How a table writes its numbers. @param decimals as the field says
using NumberText = std::string (*)(double value, int decimals);

/// The first line, without line end. @param example a record with the fields that the file has
template <class T>
std::string csv_header(const T& example = {}) {
  std::string line;
  each_column<kCsv>(example, [&](const Field& field, const auto&) { line += name_of(field) + ','; });
  line.pop_back();
  return line;
}

template <class V>
std::string csv_cell(const Field& field, const V& value, NumberText number) {
  if constexpr (std::is_enum_v<V>) {
    return to_string(value);
  } else if constexpr (std::same_as<V, std::string>) {
    return results::csv_text(value);
  } else if constexpr (std::same_as<V, std::size_t>) {
    return fmt::to_string(value + static_cast<std::size_t>(field.first));
  } else if constexpr (std::same_as<V, double>) {
    return number(value, field.decimals);
  } else if constexpr (requires { value.has_value(); }) {
    return value ? csv_cell(field, *value, number) : "";
  } else {
    return fmt::format("{:d}", value);
  }
}

/// A line, without line end.
template <class T>
std::string csv_line(const T& record, NumberText number = results::fixed) {
  std::string line;
  each_column<kCsv>(record,
                    [&](const Field& field, const auto& value) { line += csv_cell(field, value, number) + ','; });
  line.pop_back();
  return line;
}

/// The whole text: the header, and one line for each record. Number formats are fixed and independent of the locale, so
/// that the same records give the same bytes.
template <class Records>
std::string csv_of(const Records& records) {
  std::string text = csv_header<typename Records::value_type>() + "\n";
  for (const auto& record : records) text += csv_line(record) + "\n";
  return text;
}

}  // namespace stylet::record

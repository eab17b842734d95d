// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <concepts>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

/// One list of fields for each record: a function `columns(visit, record)` that calls `visit` once for each field, with
/// its description and its value. Files, tables, JSON and the columns in docs/results are made of the same list.
namespace stylet::record {

/// The formats that have a field.
enum Format : unsigned { kFile = 1, kCsv = 2, kJson = 4, kAll = 7 };

/// Description of a field of a record.
struct Field {
  /// Column, attribute or key. Braces stand for the component of a vector: "tip{}_mm" is tip_mm as a whole, and
  /// tip_x_mm, tip_y_mm, tip_z_mm in columns.
  const char* name;
  const char* unit = "";
  const char* meaning = "";        ///< for docs/results
  unsigned formats = kAll;         ///< those that have it
  int decimals = 6;                ///< in CSV
  int version = 1;                 ///< first version of the file's format that has it
  std::size_t bytes = 0;           ///< length of a text in a file
  int first = 0;                   ///< written for a number that is 0 in memory
  bool is_apart = false;           ///< a vector that is three columns in a file too
  bool is_anatomical = false;      ///< a vector that is an object with LR, AP, SI and norm in JSON
  bool is_unknown_before = false;  ///< not a number where an earlier version has no such column
  const char* key = nullptr;       ///< in JSON, where it differs from the name
  const char* object = nullptr;    ///< of JSON, in which the key is
  const char* component = "";      ///< of a vector: "_x", "_y", "_z"

  explicit constexpr Field(const char* its_name, const char* its_unit = "", const char* its_meaning = "")
      : name(its_name), unit(its_unit), meaning(its_meaning) {}
  constexpr Field named(const char* its_name) const { return with(&Field::name, its_name); }
  constexpr Field only(unsigned those) const { return with(&Field::formats, those); }
  constexpr Field digits(int count) const { return with(&Field::decimals, count); }
  constexpr Field since(int first_version) const { return with(&Field::version, first_version); }
  constexpr Field text(std::size_t length) const { return with(&Field::bytes, length); }
  constexpr Field from_one() const { return with(&Field::first, 1); }
  constexpr Field apart() const { return with(&Field::is_apart, true); }
  constexpr Field anatomical() const { return with(&Field::is_anatomical, true); }
  constexpr Field unknown_before() const { return with(&Field::is_unknown_before, true); }
  constexpr Field as(const char* json_key) const { return with(&Field::key, json_key); }
  constexpr Field in(const char* json_object) const { return with(&Field::object, json_object); }
  constexpr Field of(const char* its_component) const { return with(&Field::component, its_component); }

 private:
  template <class T>
  constexpr Field with(T Field::*member, T value) const {
    Field changed = *this;
    changed.*member = value;
    return changed;
  }
};

inline constexpr std::array kComponents{"_x", "_y", "_z"};

/// The name of a column.
inline std::string name_of(const Field& field) {
  std::string name = field.name;
  if (const std::size_t at = name.find("{}"); at != std::string::npos) name.replace(at, 2, field.component);
  return name;
}

/// The type of a record in a list of fields, which serves for reading and, with const, for writing.
template <class T, class Record>
concept Of = std::same_as<std::remove_const_t<T>, Record>;

struct NoVisit {
  void operator()(const Field& field, auto&& value) const;
};
template <class T>
concept HasColumns = requires(T& record, NoVisit& visit) {
  columns(visit, record);
};

/// Whether the rows of a record have a check in files.
template <class T>
inline constexpr bool has_check = false;

/// Calls act(field, value) for each field that a format has.
template <Format in, class T, class Act>
void each_field(T& record, const Act& act) {
  const auto visit = [&](const Field& field, auto&& value) {
    if ((field.formats & in) != 0) act(field, value);
  };
  columns(visit, record);
}

/// The same, with the three components of a vector one by one where they are columns of their own.
template <Format in, class T, class Act>
void each_column(T& record, const Act& act) {
  each_field<in>(record, [&](const Field& field, auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::same_as<V, std::optional<Vec3>>) {
      for (std::size_t k = 0; k < 3; ++k)
        act(field.of(kComponents[k]),
            value ? std::optional((*value)[static_cast<Eigen::Index>(k)]) : std::optional<double>());
    } else if constexpr (std::same_as<V, Vec3>) {
      if constexpr (in != kCsv)
        if (!field.is_apart) return act(field, value);
      for (std::size_t k = 0; k < 3; ++k) act(field.of(kComponents[k]), value[static_cast<Eigen::Index>(k)]);
    } else {
      act(field, value);
    }
  });
}

/// Number of the values of an enumeration, which begin at 0: to_string() has a name for each of them.
template <class Enum>
int count_of() {
  const char* none = to_string(static_cast<Enum>(-1));
  int count = 0;
  while (std::strcmp(to_string(static_cast<Enum>(count)), none) != 0) ++count;
  return count;
}

/// The value of an enumeration that has a name.
template <class Enum>
std::optional<Enum> value_named(const std::string& name) {
  for (int k = 0; k < count_of<Enum>(); ++k) {
    if (name == to_string(static_cast<Enum>(k))) return static_cast<Enum>(k);
  }
  return std::nullopt;
}

}  // namespace stylet::record

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "results/h5.hpp"
#include "stylet/core/field.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

/// Records as rows of an HDF5 dataset: their columns one after the other without gaps, then the check.
namespace stylet::record {

inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// The number that a file has for a value: one byte for enumerations and truth values, NaN for a number that is unset.
template <class V>
auto stored(const Field& field, const V& value) {
  if constexpr (std::is_enum_v<V> || std::same_as<V, bool>) {
    return static_cast<std::int8_t>(value);
  } else if constexpr (std::same_as<V, std::size_t>) {
    return static_cast<std::int64_t>(value) + field.first;
  } else if constexpr (std::same_as<V, std::optional<double>>) {
    return value.value_or(kNotANumber);
  } else {
    static_assert(std::is_arithmetic_v<V>);
    return value;
  }
}

/// The inverse. @return false if no value has this number
template <class V, class Stored>
bool restore(const Field& field, Stored number, V& value) {
  if constexpr (std::is_enum_v<V>) {
    value = static_cast<V>(number);
    return number >= 0 && number < count_of<V>();
  } else if constexpr (std::same_as<V, std::size_t>) {
    value = static_cast<std::size_t>(number - field.first);
    return number >= field.first;
  } else if constexpr (std::same_as<V, std::optional<double>>) {
    value = std::isnan(number) ? std::nullopt : std::optional(number);
    return true;
  } else {
    value = static_cast<V>(number);
    return true;
  }
}

/// Copies a text into a field of fixed length; a text that is too long is cut between two UTF-8 characters.
inline std::string padded(const std::string& text, std::size_t length) {
  std::size_t kept = std::min(text.size(), length);
  while (kept > 0 && kept < text.size() && (static_cast<unsigned char>(text[kept]) & 0xC0U) == 0x80U) --kept;
  std::string field = text.substr(0, kept);
  field.resize(length);
  return field;
}

inline h5::Handle type_of(const Field& field, const std::string&) { return h5::string_type(field.bytes); }
inline h5::Handle type_of(const Field&, const Vec3&) { return h5::array_type(H5T_NATIVE_DOUBLE, 3); }
template <class V>
h5::Handle type_of(const Field& field, const V& value) {
  if constexpr (std::same_as<V, bool>) {
    return h5::bool_type();
  } else if constexpr (std::is_enum_v<V>) {
    return h5::enum_type(count_of<V>(), [](int k) { return to_string(static_cast<V>(k)); });
  } else {
    return {h5::number_type(stored(field, value)), nullptr};
  }
}

struct Column {
  std::string name;
  std::size_t offset = 0, bytes = 0;
  bool is_text = false;
};

/// Appends the values of a record to `bytes`.
template <class T>
void pack(std::string& bytes, const T& record) {
  each_column<kFile>(record, [&](const Field& field, const auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::same_as<V, std::string>) {
      bytes += padded(value, field.bytes);
    } else if constexpr (std::same_as<V, Vec3>) {
      bytes.append(reinterpret_cast<const char*>(value.data()), sizeof value);
    } else {
      const auto number = stored(field, value);
      bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
  });
}

/// The inverse. @return false if a number is that of no value
template <class T>
bool unpack(const char* from, T& record) {
  bool good = true;
  each_column<kFile>(record, [&](const Field& field, auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::same_as<V, std::string>) {
      value.assign(from, strnlen(from, field.bytes));
      from += field.bytes;
    } else if constexpr (std::same_as<V, Vec3>) {
      std::memcpy(value.data(), from, sizeof value);
      from += sizeof value;
    } else {
      auto number = stored(field, V{});
      std::memcpy(&number, from, sizeof number);
      from += sizeof number;
      good = restore(field, number, value) && good;
    }
  });
  return good;
}

/// The columns of a record, without its check.
template <class T>
const std::vector<Column>& columns_of() {
  static const std::vector<Column> all = [] {
    std::vector<Column> list;
    std::size_t offset = 0;
    each_column<kFile>(static_cast<const T&>(T{}), [&](const Field& field, const auto& value) {
      using V = std::remove_cvref_t<decltype(value)>;
      std::size_t bytes = field.bytes;
      if constexpr (std::same_as<V, Vec3>)
        bytes = sizeof value;
      else if constexpr (!std::same_as<V, std::string>)
        bytes = sizeof stored(field, value);
      list.push_back({name_of(field), offset, bytes, std::same_as<V, std::string>});
      offset += bytes;
    });
    return list;
  }();
  return all;
}

template <class T>
std::size_t row_bytes() {
  return columns_of<T>().back().offset + columns_of<T>().back().bytes + (has_check<T> ? sizeof(std::uint32_t) : 0);
}

/// The compound type of a row.
template <class T>
h5::Handle row_type() {
  h5::Handle type = h5::compound_type(row_bytes<T>());
  auto column = columns_of<T>().begin();
  each_column<kFile>(static_cast<const T&>(T{}), [&](const Field& field, const auto& value) {
    h5::insert_member(type, column->name.c_str(), column->offset, type_of(field, value));
    ++column;
  });
  if (has_check<T>) h5::insert_member(type, "check", row_bytes<T>() - sizeof(std::uint32_t), H5T_NATIVE_UINT32);
  return type;
}

/// The newest version of the format that a field of these records belongs to: the version of a file with all of them.
template <class... T>
int newest_version() {
  int newest = 0;
  const auto visit = [&](const Field& field, auto&&) { newest = std::max(newest, field.version); };
  (columns(visit, static_cast<const T&>(T{})), ...);
  return newest;
}

/// A row of which nothing has reached the disk: its numbers are NaN or 0, its texts empty.
/// @param only_unknown leave those numbers as they are in a new record that are not Field::is_unknown_before
template <class T>
std::string empty_row(bool only_unknown) {
  T record{};
  each_column<kFile>(record, [&](const Field& field, auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if (only_unknown && !field.is_unknown_before) return;
    if constexpr (std::same_as<V, double>) value = kNotANumber;
    if constexpr (std::same_as<V, Vec3>) value.setConstant(kNotANumber);
  });
  std::string bytes;
  pack(bytes, record);
  bytes.resize(row_bytes<T>());
  return bytes;
}

/// CRC-32 of bytes, continued from an earlier value.
inline std::uint32_t check_of(const void* data, std::size_t bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(::crc32_z(before, static_cast<const Bytef*>(data), bytes));
}

/// Rows as they are in a file.
template <class T>
struct Rows {
  std::string bytes;        ///< with a check at the end of each row if has_check<T>
  std::vector<char> known;  ///< for each of columns_of<T>(): whether the file has it

  Rows() : known(columns_of<T>().size(), 1) {}
  [[nodiscard]] std::size_t size() const { return bytes.size() / row_bytes<T>(); }
  [[nodiscard]] const char* at(std::size_t k) const { return bytes.data() + k * row_bytes<T>(); }

  /// @param more what belongs to this row besides its columns, for its check
  void add(const T& record, std::span<const std::span<const std::byte>> more = {}) {
    const std::size_t begin = bytes.size();
    pack(bytes, record);
    if constexpr (has_check<T>) {
      std::uint32_t check = check_of(bytes.data() + begin, bytes.size() - begin);
      for (const auto& part : more) check = check_of(part.data(), part.size(), check);
      bytes.append(reinterpret_cast<const char*>(&check), sizeof check);
    }
  }
  /// Calls act(bytes, column) for each value of row k that is in the file.
  template <class Act>
  void each_value(std::size_t k, const Act& act) const {
    for (std::size_t c = 0; c < known.size(); ++c) {
      const Column& column = columns_of<T>()[c];
      if (known[c] != 0) act(std::span(at(k) + column.offset, column.bytes), column);
    }
  }
  /// Whether row k has the check that belongs to its columns and to `more`.
  [[nodiscard]] bool is_whole(std::size_t k, std::span<const std::span<const std::byte>> more = {}) const {
    std::uint32_t check = 0, said = 0;
    each_value(
        k, [&](std::span<const char> value, const Column&) { check = check_of(value.data(), value.size(), check); });
    for (const auto& part : more) check = check_of(part.data(), part.size(), check);
    std::memcpy(&said, at(k + 1) - sizeof said, sizeof said);
    return said == check;
  }
  /// Reads row k into `record`. @return false if a number in it is that of no value
  [[nodiscard]] bool get(std::size_t k, T& record) const { return unpack(at(k), record); }
};

template <class T>
void fields(auto& wire, Rows<T>& rows) {
  wire(rows.bytes, rows.known);
}

template <class T>
Rows<T> rows_of(std::span<const T> records) {
  Rows<T> rows;
  rows.bytes.reserve(records.size() * row_bytes<T>());
  for (const T& record : records) rows.add(record);
  return rows;
}

/// Writes records as a dataset of fixed size.
template <class T>
void write_rows(hid_t parent, const char* name, const Rows<T>& rows) {
  const hsize_t count = rows.size();
  h5::write_array(parent, name, row_type<T>(), {&count, 1}, rows.bytes.data());
}

/// Reads a dataset. Columns that this program does not know are skipped; those that the file lacks are as in a new
/// record, or NaN (Field::is_unknown_before). Throws h5::Failure.
/// @param most only so many of the last rows
template <class T>
Rows<T> read_rows(hid_t parent, const char* name, hsize_t most = std::numeric_limits<hsize_t>::max()) {
  const h5::Handle set = h5::dataset(parent, name);
  const auto shape = h5::extents(set);
  if (shape.size() != 1) throw h5::Failure(std::string(name) + " must have one axis");
  Rows<T> rows;
  const std::string row = empty_row<T>(true);
  const hsize_t count = std::min(shape[0], most);
  rows.bytes.reserve(count * row.size());
  for (hsize_t k = 0; k < count; ++k) rows.bytes += row;
  for (std::size_t c = 0; c < rows.known.size(); ++c)
    rows.known[c] = h5::has_member(set, columns_of<T>()[c].name.c_str()) ? 1 : 0;
  h5::read_rows(set, row_type<T>(), shape[0] - count, count, std::as_writable_bytes(std::span(rows.bytes)));
  return rows;
}

/// A dataset that grows.
template <class T>
class Table {
 public:
  Table() = default;
  Table(hid_t parent, const char* name, hsize_t rows_in_chunk) : type_(row_type<T>()) {
    data_ = h5::growing_dataset(parent, name, type_, {}, rows_in_chunk, empty_row<T>(false).data());
  }
  void append(const Rows<T>& rows) {
    h5::append_rows(data_, type_, rows.size(), rows.bytes.data());
    count_ += static_cast<std::int64_t>(rows.size());
  }
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] bool is_open() const { return data_ >= 0; }
  /// Closes the dataset. @return false if the last writing failed
  bool close() {
    type_.reset();
    return data_.reset();
  }

 private:
  h5::Handle type_, data_;
  std::int64_t count_ = 0;
};

}  // namespace stylet::record

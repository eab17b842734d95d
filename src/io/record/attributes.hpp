// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "results/h5.hpp"
#include "stylet/core/field.hpp"

#include <span>

/// Records as attributes of an object in an HDF5 file.
namespace stylet::record {

template <class V>
void write_attribute(hid_t object, const std::string& name, const V& value) {
  if constexpr (std::same_as<V, std::string>) {
    h5::write_attribute(object, name.c_str(), value);
  } else if constexpr (std::is_enum_v<V>) {
    h5::write_attribute(object, name.c_str(), std::string(to_string(value)));
  } else if constexpr (std::is_integral_v<V>) {
    h5::write_attribute(object, name.c_str(), std::array{static_cast<int>(value)});
  } else if constexpr (std::same_as<V, double>) {
    h5::write_attribute(object, name.c_str(), std::array{value});
  } else {
    h5::write_attribute(object, name.c_str(),
                        std::span(std::as_const(value).data(), static_cast<std::size_t>(value.size())));
  }
}

/// Copies numbers into a value that has its length already.
template <class Number, class V>
void take_numbers(const std::vector<Number>& numbers, V& value, const std::string& name) {
  if (numbers.size() != static_cast<std::size_t>(value.size()))
    throw h5::Failure("attribute " + name + " has the wrong size");
  std::copy(numbers.begin(), numbers.end(), value.data());
}

/// Throws h5::Failure.
template <class V>
void read_attribute(hid_t object, const std::string& name, V& value) {
  const char* key = name.c_str();
  if constexpr (std::same_as<V, std::string>) {
    value = h5::read_text_attribute(object, key);
  } else if constexpr (std::is_enum_v<V>) {
    const auto named = value_named<V>(h5::read_text_attribute(object, key));
    if (!named) throw h5::Failure("attribute " + name + " has an unknown value");
    value = *named;
  } else if constexpr (std::is_integral_v<V>) {
    std::array<int, 1> number{};
    take_numbers(h5::read_int_attribute(object, key), number, name);
    if (number[0] < 0 && std::is_unsigned_v<V>) throw h5::Failure("attribute " + name + " is negative");
    value = static_cast<V>(number[0]);
  } else if constexpr (std::same_as<V, double>) {
    std::array<double, 1> number{};
    take_numbers(h5::read_double_attribute(object, key), number, name);
    value = number[0];
  } else if constexpr (std::same_as<V, Vec3>) {
    take_numbers(h5::read_double_attribute(object, key), value, name);
  } else if constexpr (std::same_as<V, std::vector<int>>) {
    value = h5::read_int_attribute(object, key);
  } else {
    take_numbers(h5::read_int_attribute(object, key), value, name);
  }
}

template <class T>
void write_attributes(hid_t object, const T& record) {
  each_field<kFile>(record,
                    [&](const Field& field, const auto& value) { write_attribute(object, name_of(field), value); });
}

/// Whether an object has the attribute of a field; those of later versions may be missing.
inline bool lacks(hid_t object, const Field& field) {
  return field.version > 1 && !h5::has_attribute(object, name_of(field).c_str());
}

/// Throws h5::Failure.
template <class T>
void read_attributes(hid_t object, T& record) {
  each_field<kFile>(record, [&](const Field& field, auto& value) {
    if (!lacks(object, field)) read_attribute(object, name_of(field), value);
  });
}

}  // namespace stylet::record

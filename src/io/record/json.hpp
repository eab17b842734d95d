// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/field.hpp"
#include "stylet/core/json_text.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

/// Records as objects of JSON. A number that does not exist is null.
namespace stylet::record {

using Json = nlohmann::ordered_json;

/// A value, or null where there is none.
template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
/// A text, or null where it is empty.
inline Json or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }
/// A number, or null where it is 0, which stands for none.
inline Json or_null(double positive) { return positive > 0.0 ? Json(positive) : Json(nullptr); }

/// Text for files and for scripts: json_text().
inline std::string pretty(const Json& json) { return json_text(json, 2) + "\n"; }
inline std::string compact(const Json& json) { return json_text(json); }

/// A key or a word that a record cannot have.
struct BadJson : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Three numbers; null for those that are not finite.
inline Json list_of(const Vec3& v) {
  Json list = Json::array();
  for (const double x : v) list.push_back(std::isfinite(x) ? Json(x) : Json(nullptr));
  return list;
}

/// A vector by anatomical directions; null for one that does not exist.
inline Json anatomical(const Vec3& v) {
  if (!v.allFinite()) return nullptr;
  return {{"LR", v.x()}, {"AP", v.y()}, {"SI", v.z()}, {"norm", v.norm()}};
}

template <class T>
Json json_of(const T& record);

template <class V>
Json json_value(const Field& field, const V& value) {
  if constexpr (HasColumns<V>) {
    return json_of(value);
  } else if constexpr (std::is_enum_v<V>) {
    return to_string(value);
  } else if constexpr (std::same_as<V, std::size_t>) {
    return value + static_cast<std::size_t>(field.first);
  } else if constexpr (std::same_as<V, Vec3>) {
    return field.is_anatomical ? anatomical(value) : list_of(value);
  } else if constexpr (requires { value.has_value(); }) {
    return value ? json_value(field, *value) : Json(nullptr);
  } else if constexpr (requires { requires HasColumns<typename V::value_type>; }) {
    Json list = Json::array();
    for (const auto& item : value) list.push_back(json_of(item));
    return list;
  } else {
    return value;
  }
}

inline std::string key_of(const Field& field) { return field.key ? field.key : name_of(field); }

/// The object of a record, with its keys in the order of the list.
template <class T>
Json json_of(const T& record) {
  Json json = Json::object();
  each_field<kJson>(record, [&](const Field& field, const auto& value) {
    (field.object ? json[field.object] : json)[key_of(field)] = json_value(field, value);
  });
  return json;
}

template <class T>
void read_json(const Json& json, T& record);

template <class V>
void read_value(const Field& field, const Json& json, V& value) {
  if constexpr (HasColumns<V>) {
    read_json(json, value);
  } else if constexpr (std::is_enum_v<V>) {
    const auto named = value_named<V>(json.get<std::string>());
    if (!named) throw BadJson(key_of(field) + " '" + json.get<std::string>() + "' is unknown");
    value = *named;
  } else if constexpr (std::same_as<V, double>) {
    value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
  } else if constexpr (std::same_as<V, Vec3>) {
    const std::array names{"LR", "AP", "SI"};
    for (std::size_t k = 0; k < 3; ++k) {
      const Json& component = json.is_null() ? json : field.is_anatomical ? json.at(names[k]) : json.at(k);
      read_value(field, component, value[static_cast<Eigen::Index>(k)]);
    }
  } else if constexpr (requires { value.has_value(); }) {
    value.reset();
    if (!json.is_null()) read_value(field, json, value.emplace());
  } else if constexpr (requires { requires HasColumns<typename V::value_type>; }) {
    value.clear();
    for (const Json& item : json) read_json(item, value.emplace_back());
  } else {
    value = json.get<V>();
  }
}

/// Reads an object. A key of a later version (Field::since) may be missing. Throws Json::exception and BadJson.
template <class T>
void read_json(const Json& json, T& record) {
  each_field<kJson>(record, [&](const Field& field, auto& value) {
    const Json& object = field.object ? json.at(field.object) : json;
    const std::string key = key_of(field);
    if (field.version == 1 || object.contains(key)) read_value(field, object.at(key), value);
  });
}

}  // namespace stylet::record

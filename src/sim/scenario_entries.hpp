// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scenario_table.hpp"

#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet {

/// Conversion of the scenario's fields to ScenarioValue.
namespace scenario_field {

using Type = ScenarioValue::Type;

inline std::optional<ScenarioValue> value_of(double x) { return ScenarioValue{.type = Type::number, .number = x}; }
inline std::optional<ScenarioValue> value_of(int x) {
  return ScenarioValue{.type = Type::integer, .number = static_cast<double>(x)};
}
inline std::optional<ScenarioValue> value_of(bool x) { return ScenarioValue{.type = Type::boolean, .boolean = x}; }
inline std::optional<ScenarioValue> value_of(const std::string& x) {
  return ScenarioValue{.type = Type::text, .text = x};
}
template <Choice E>
std::optional<ScenarioValue> value_of(E x) {
  return ScenarioValue{.type = Type::text, .text = word(x)};
}
inline std::optional<ScenarioValue> value_of(const std::vector<std::string>& x) {
  return ScenarioValue{.type = Type::texts, .texts = x};
}
inline std::optional<ScenarioValue> value_of(const std::vector<double>& x) {
  return ScenarioValue{.type = Type::numbers, .numbers = x};
}
template <std::size_t n>
std::optional<ScenarioValue> value_of(const std::array<double, n>& x) {
  return ScenarioValue{.type = Type::numbers, .numbers = {x.begin(), x.end()}};
}
template <class T>
std::optional<ScenarioValue> value_of(const std::optional<T>& x) {
  return x ? value_of(*x) : std::nullopt;
}

}  // namespace scenario_field

/// Texts for the documentation of a key that replace the value of a new Scenario.
struct Documented {
  const char* standard = nullptr;  ///< the default in words, e.g. "by region"
  const char* example = nullptr;   ///< a value as in a file
};

/// Builds the table of keys. `field` is a generic function that takes a Scenario, const or not, and a slot, and returns
/// a pointer to the field; the same function serves reading, writing and the default.
class ScenarioEntries {
 public:
  using Type = ScenarioValue::Type;

  /// @param unit unit of low, high and the value
  template <class Field>
  void number(const char* path, const char* unit, double low, double high, const char* meaning, Field field,
              Documented doc = {}) {
    add({path, Type::number, unit, "", fmt::format("{} … {}", low, high), meaning, ""}, field, doc,
        [=](auto& target, const ScenarioValue& v) -> std::string {
          if (!(v.number >= low && v.number <= high)) return "outside its range";
          target = v.number;
          return {};
        });
  }

  template <class Field>
  void integer(const char* path, int low, int high, const char* meaning, Field field, Documented doc = {}) {
    add({path, Type::integer, "", "", fmt::format("{} … {}", low, high), meaning, ""}, field, doc,
        [=](auto& target, const ScenarioValue& v) -> std::string {
          if (v.number != std::floor(v.number)) return "not a whole number";
          if (!(v.number >= low && v.number <= high)) return "outside its range";
          target = static_cast<int>(v.number);
          return {};
        });
  }

  template <class Field>
  void boolean(const char* path, const char* meaning, Field field, Documented doc = {}) {
    add({path, Type::boolean, "", "", "true or false", meaning, ""}, field, doc,
        [](auto& target, const ScenarioValue& v) -> std::string {
          target = v.boolean;
          return {};
        });
  }

  template <class Field>
  void text(const char* path, const char* meaning, Field field, Documented doc = {}) {
    add({path, Type::text, "", "", "text", meaning, ""}, field, doc,
        [](auto& target, const ScenarioValue& v) -> std::string {
          target = v.text;
          return {};
        });
  }

  /// One of an enumeration's words.
  template <class Field>
  void choice(const char* path, const char* meaning, Field field) {
    using E = std::decay_t<decltype(field_value(field, ScenarioSlot{}))>;
    const std::vector<std::string> words(Words<E>::all.begin(), Words<E>::all.end());
    add({path, Type::text, "", "", fmt::format("\"{}\"", fmt::join(words, "\", \"")), meaning, ""}, field, {},
        [=](auto& target, const ScenarioValue& v) -> std::string {
          const auto chosen = stylet::choice<E>(v.text);
          if (!chosen) {
            const std::string near = nearest_name(v.text, words);
            return "not an allowed word" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)");
          }
          target = *chosen;
          return {};
        });
  }

  template <std::size_t n, class Field>
  void vector(const char* path, const char* unit, double low, double high, const char* meaning, Field field,
              Documented doc = {}) {
    add({path, Type::numbers, unit, "", fmt::format("{} numbers, each {} … {}", n, low, high), meaning, ""}, field, doc,
        [=](auto& target, const ScenarioValue& v) -> std::string {
          if (v.numbers.size() != n) return fmt::format("{} numbers long, not {}", v.numbers.size(), n);
          std::array<double, n> numbers{};
          for (std::size_t i = 0; i < n; ++i) {
            if (!(v.numbers[i] >= low && v.numbers[i] <= high)) return "outside its range";
            numbers[i] = v.numbers[i];
          }
          target = numbers;
          return {};
        });
  }

  /// A list of numbers in ascending order; it may be empty.
  template <class Field>
  void ascending(const char* path, const char* unit, double low, double high, const char* meaning, Field field,
                 Documented doc = {}) {
    add({path, Type::numbers, unit, "", fmt::format("ascending numbers, each {} … {}", low, high), meaning, ""}, field,
        doc, [=](auto& target, const ScenarioValue& v) -> std::string {
          for (std::size_t i = 0; i < v.numbers.size(); ++i) {
            if (!(v.numbers[i] >= low && v.numbers[i] <= high)) return "outside its range";
            if (i > 0 && v.numbers[i] <= v.numbers[i - 1]) return "not in ascending order";
          }
          target = v.numbers;
          return {};
        });
  }

  /// A list of different texts, none of them empty.
  template <class Field>
  void texts(const char* path, std::size_t least, const char* meaning, Field field, Documented doc = {}) {
    const std::string range = least == 0 ? "list of texts" : fmt::format("different texts, at least {}", least);
    add({path, Type::texts, "", "", range, meaning, ""}, field, doc,
        [=](auto& target, const ScenarioValue& v) -> std::string {
          if (v.texts.size() < least) return fmt::format("too short ({} texts)", v.texts.size());
          for (auto text = v.texts.begin(); text != v.texts.end(); ++text) {
            if (text->empty()) return "a list with an empty text in it";
            if (std::find(v.texts.begin(), text, *text) != text) return "a list with \"" + *text + "\" twice";
          }
          target = v.texts;
          return {};
        });
  }

  [[nodiscard]] std::vector<ScenarioEntry> take() && { return std::move(entries_); }

 private:
  template <class Field, class Store>
  void add(ScenarioKey key, Field field, Documented doc, Store store) {
    ScenarioEntry entry;
    entry.store = [=](Scenario& s, const ScenarioSlot& slot, const ScenarioValue& v) -> std::string {
      // Store into a copy first, so that a refused value does not create a new tissue or insertion.
      auto value = field_value(field, slot);
      std::string refusal = store(value, v);
      if (refusal.empty()) *field(s, slot) = std::move(value);
      return refusal;
    };
    entry.load = [=](const Scenario& s, const ScenarioSlot& slot) { return scenario_field::value_of(*field(s, slot)); };
    // The documented default is read from a new scenario, so that it cannot differ from the real one.
    Scenario fresh;
    const auto standard = scenario_field::value_of(*field(fresh, ScenarioSlot{"prostate", 0}));
    const bool unset = !standard || (standard->type == Type::text && standard->text.empty());
    key.standard = doc.standard ? doc.standard : (unset ? "none" : to_string(*standard));
    key.example = doc.example ? doc.example : (unset ? "" : to_string(*standard));
    entry.key = std::move(key);
    entries_.push_back(std::move(entry));
  }

  /// A value of the field's type.
  template <class Field>
  static auto field_value(Field field, const ScenarioSlot& slot) {
    Scenario fresh;
    return *field(fresh, ScenarioSlot{slot.name, 0});
  }

  std::vector<ScenarioEntry> entries_;
};

}  // namespace stylet

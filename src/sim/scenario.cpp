// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/scenario.hpp"

#include "scenario_table.hpp"
#include "stylet/core/nearest_name.hpp"
#include "stylet/sim/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

/// Finds, sets and reads single keys of a scenario by their path.
namespace stylet {

namespace {

using Type = ScenarioValue::Type;

constexpr const char* kAllKeys = "Run stylet insert --print-schema for a list of all keys";

/// Tables of a scenario that form lists.
constexpr std::array<std::string_view, 3> kLists{"insertion", "plan.needle", "plan.goal"};

/// Number of entries of one of these lists.
std::size_t entries_of(const Scenario& scenario, std::string_view list) {
  if (list == "insertion") return scenario.insertions.size();
  return list == "plan.needle" ? scenario.plan.needles.size() : scenario.plan.goal_table.size();
}

/// The list to which a path or a pattern belongs, "insertion" for "insertion[0].hole"; empty if to none.
std::string_view list_of(std::string_view path) {
  for (const std::string_view list : kLists) {
    if (path.starts_with(list) && path.substr(list.size()).starts_with('[')) return list;
  }
  return {};
}

/// "tissue.prostate.young_kPa" → "tissue.<region>.young_kPa" and the slot; "insertion[2].hole" → "insertion[].hole".
std::string pattern_of(const std::string& path, ScenarioSlot& slot) {
  constexpr std::string_view tissue = "tissue.";
  constexpr std::string_view regions = "patient.regions.";
  const std::string_view list = list_of(path);
  if (path.starts_with(tissue)) {
    // The name of a region may contain dots, a key does not: the last dot separates them.
    const auto dot = path.rfind('.');
    if (dot > tissue.size()) {
      slot.name = path.substr(tissue.size(), dot - tissue.size());
      return "tissue.<region>" + path.substr(dot);
    }
  } else if (path.starts_with(regions) && path.size() > regions.size()) {
    slot.name = path.substr(regions.size());
    return "patient.regions.<name>";
  } else if (!list.empty()) {
    const auto first = list.size() + 1;
    const auto close = path.find_first_not_of("0123456789", first);
    const auto digits = close - first;
    if (close != std::string::npos && path[close] == ']' && digits > 0 && digits < 4) {
      slot.index = std::stoul(path.substr(first, digits));
      return std::string(list) + "[]" + path.substr(close + 1);
    }
    // The index is not a number: without it the key is unknown, but nearest_key() finds a similar one.
    const auto end = path.find(']');
    return std::string(list) + (end == std::string::npos ? "" : path.substr(end + 1));
  }
  return path;
}

const ScenarioEntry* find(const std::string& pattern) {
  const auto& table = scenario_table();
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& e) { return e.key.path == pattern; });
  return found == table.end() ? nullptr : &*found;
}

std::string type_name(Type type) {
  switch (type) {
    case Type::number:
      return "a number";
    case Type::integer:
      return "a whole number";
    case Type::boolean:
      return "true or false";
    case Type::text:
      return "a text in quotes";
    case Type::numbers:
      return "a list of numbers";
    case Type::texts:
      return "a list of texts in quotes";
  }
  return {};
}

bool fits(const ScenarioValue& value, Type type) {
  if (value.type == type) return true;
  if (type == Type::number || type == Type::integer) return value.type == Type::number || value.type == Type::integer;
  // An empty list fits both types of lists.
  if (type == Type::numbers || type == Type::texts) {
    return (value.type == Type::numbers || value.type == Type::texts) && value.numbers.empty() && value.texts.empty();
  }
  return false;
}

/// The last clause of an error: the values that the key accepts.
std::string cure_for(const ScenarioKey& key) {
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  switch (key.type) {
    case Type::number:
    case Type::integer:
      return fmt::format("Give {} in {}{}", type_name(key.type), key.range, unit);
    case Type::boolean:
      return "Give true or false, without quotes";
    case Type::text:
      if (key.range != "text") return "Give one of " + key.range;
      return key.example.empty() ? "Give a text in quotes" : "Give a text in quotes, for example " + key.example;
    case Type::numbers:
    case Type::texts:
      return fmt::format("Give {}{}, for example {}", key.range, unit, key.example);
  }
  return {};
}

/// Addition to the cure for a text in place of a number: "20cm" and "0,06" have the number in another notation.
std::string about_notation(const ScenarioValue& value, const ScenarioKey& key) {
  const bool number = key.type == Type::number || key.type == Type::integer;
  const bool begins_with_one = value.type == Type::text && value.text.find_first_of("0123456789") < 2;
  if (!number || !begins_with_one) return {};
  return value.text.find(',') != std::string::npos ? ", with a decimal point instead of the comma"
                                                   : ", the number alone, without a unit";
}

/// Addition to the cure for a number out of range: the unit in which it probably is.
std::string probable_unit(const ScenarioValue& value, const ScenarioKey& key) {
  for (const PlausibleRange& range : plausible_ranges()) {
    if (range.key != key.path) continue;
    const std::string& advice = value.number > range.high ? range.above : range.below;
    return advice.empty() ? std::string() : ". " + advice;
  }
  return {};
}

/// "needle.length_mm" → "needle", "length_mm"; "name" → "", "name".
std::pair<std::string, std::string> table_and_leaf(const std::string& pattern) {
  const auto dot = pattern.rfind('.');
  if (dot == std::string::npos) return {"", pattern};
  return {pattern.substr(0, dot), pattern.substr(dot + 1)};
}

/// A pattern with the wildcards replaced by the slot's name and index.
std::string spelled_out(std::string pattern, const ScenarioSlot& slot) {
  const auto replace = [&](std::string_view what, const std::string& by) {
    if (const auto at = pattern.find(what); at != std::string::npos) pattern.replace(at, what.size(), by);
  };
  replace("<region>", slot.name.empty() ? "REGION" : slot.name);
  replace("<name>", slot.name.empty() ? "NAME" : slot.name);
  replace("[]", fmt::format("[{}]", slot.index));
  return pattern;
}

/// The known key that is most similar to an unknown one: a similar name in the same table, or else a similar name in
/// any table; empty if there is none.
std::string nearest_key(const std::string& pattern) {
  const auto [table, leaf] = table_and_leaf(pattern);
  std::vector<std::string> here;
  std::vector<std::string> all;
  for (const ScenarioEntry& entry : scenario_table()) {
    const auto [its_table, its_leaf] = table_and_leaf(entry.key.path);
    if (its_table == table) here.push_back(its_leaf);
    all.push_back(its_leaf);
  }
  if (const std::string near = nearest_name(leaf, here); !near.empty()) {
    return table.empty() ? near : table + "." + near;
  }
  const std::string near = nearest_name(leaf, all);
  if (near.empty()) return {};
  return scenario_table()[static_cast<std::size_t>(std::find(all.begin(), all.end(), near) - all.begin())].key.path;
}

Error unknown_key(const std::string& path, const std::string& pattern, const ScenarioSlot& slot,
                  const std::string& where) {
  const std::string near = nearest_key(pattern);
  return input_error(where, "unknown key " + path,
                     near.empty() ? kAllKeys : fmt::format("Did you mean {}? {}", spelled_out(near, slot), kAllKeys));
}

Result<> store(Scenario& scenario, const ScenarioEntry& entry, const ScenarioSlot& slot, const std::string& path,
               const ScenarioValue& value, const std::string& where) {
  const std::string stated = path + " = " + to_string(value);
  if (!fits(value, entry.key.type)) {
    return input_error(where, stated + " is not " + type_name(entry.key.type),
                       cure_for(entry.key) + about_notation(value, entry.key));
  }
  if (value.type == Type::number && !std::isfinite(value.number)) {
    return input_error(where, stated + " is not finite", cure_for(entry.key));
  }
  const std::string refusal = entry.store(scenario, slot, value);
  if (!refusal.empty())
    return input_error(where, stated + " is " + refusal, cure_for(entry.key) + probable_unit(value, entry.key));
  return Ok{};
}

/// All slots of a scenario that a pattern's wildcards can stand for.
std::vector<ScenarioSlot> slots(const Scenario& scenario, const std::string& pattern) {
  std::vector<ScenarioSlot> result;
  if (pattern.starts_with("tissue.<region>")) {
    for (const auto& [name, parameters] : scenario.tissue) result.push_back({name, 0});
  } else if (pattern.starts_with("patient.regions.")) {
    for (const auto& [name, region] : scenario.patient.regions) result.push_back({name, 0});
  } else if (const std::string_view list = list_of(pattern); !list.empty()) {
    for (std::size_t k = 0; k < entries_of(scenario, list); ++k) result.push_back({"", k});
  } else {
    result.emplace_back();
  }
  return result;
}

}  // namespace

std::string to_string(const ScenarioValue& value) {
  const auto quoted = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') {
        (out += '\\') += c;
      } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
        out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
      } else {
        out += c;
      }
    }
    return out + '"';
  };
  switch (value.type) {
    case Type::number:
    case Type::integer:
      return fmt::format("{}", value.number);
    case Type::boolean:
      return value.boolean ? "true" : "false";
    case Type::text:
      return quoted(value.text);
    case Type::numbers:
      return fmt::format("[{}]", fmt::join(value.numbers, ", "));
    case Type::texts: {
      std::vector<std::string> texts;
      std::transform(value.texts.begin(), value.texts.end(), std::back_inserter(texts), quoted);
      return fmt::format("[{}]", fmt::join(texts, ", "));
    }
  }
  return {};
}

const std::vector<ScenarioKey>& scenario_keys() {
  static const std::vector<ScenarioKey> keys = [] {
    std::vector<ScenarioKey> all;
    for (const ScenarioEntry& entry : scenario_table()) all.push_back(entry.key);
    return all;
  }();
  return keys;
}

Result<> set_scenario_key(Scenario& scenario, const std::string& path, const ScenarioValue& value,
                          const std::string& where) {
  ScenarioSlot slot;
  const std::string pattern = pattern_of(path, slot);
  const ScenarioEntry* entry = find(pattern);
  if (!entry) return unknown_key(path, pattern, slot, where);
  return store(scenario, *entry, slot, path, value, where);
}

Result<> check_scenario_keys(const Scenario& scenario, const ScenarioPlace& place) {
  Scenario unused;  // store() needs a scenario; only its verdict on the value matters
  for (const ScenarioEntry& entry : scenario_table()) {
    for (const ScenarioSlot& slot : slots(scenario, entry.key.path)) {
      const auto value = entry.load(scenario, slot);
      if (!value) continue;
      const std::string path = spelled_out(entry.key.path, slot);
      if (Result<> stored = store(unused, entry, slot, path, *value, place(path)); !stored) return stored;
    }
  }
  return Ok{};
}

std::optional<ScenarioValue> scenario_value(const Scenario& scenario, const std::string& path) {
  ScenarioSlot slot;
  const std::string pattern = pattern_of(path, slot);
  const ScenarioEntry* entry = find(pattern);
  if (!entry) return std::nullopt;
  const bool there = !(pattern.starts_with("tissue.<region>") && !scenario.tissue.contains(slot.name)) &&
                     !(pattern.starts_with("patient.regions.") && !scenario.patient.regions.contains(slot.name)) &&
                     !(!list_of(pattern).empty() && slot.index >= entries_of(scenario, list_of(pattern)));
  return there ? entry->load(scenario, slot) : std::nullopt;
}

}  // namespace stylet
